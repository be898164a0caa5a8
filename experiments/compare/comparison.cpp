#include "experiments/compare/comparison.hpp"

#include <algorithm>
#include <fstream>
#include <optional>
#include <set>

#include "experiments/measure/exact_answer.hpp"
#include "experiments/run/run_folder.hpp"
#include "platform/atomic_file.hpp"
#include "platform/error.hpp"
#include "platform/interrupt.hpp"
#include "platform/text.hpp"

namespace ballast {
namespace {

namespace fs = std::filesystem;

struct Attempt {
  const ComparedSolver* solver;
  double tolerance;
  StartKind start;
};

/// In the order in which they are tried on one case.
std::vector<Attempt> attempts_of(const CompareOptions& options, const LoadedCase& loaded) {
  std::vector<Attempt> attempts;
  for (const double tolerance : options.tolerances)
    for (const StartKind start : options.starts) {
      if (start == StartKind::warm && loaded.warm_start.size() == 0) continue;
      for (const ComparedSolver& solver : options.solvers)
        attempts.push_back({&solver, tolerance, start});
    }
  return attempts;
}

std::string key_of(const CompareOptions& options, const std::string& binary,
                   const CompareCase& tried, const CaseFacts& facts, const Attempt& attempt,
                   int repeat) {
  const std::string numbers =
      printed("%.17g %.17g %.17g %d %.17g %.17g %d %d", attempt.tolerance, options.max_seconds,
              options.exact_seconds, options.limits.max_iterations, options.limits.memory_MB,
              options.limits.warm_seconds, options.limits.most_runs, repeat);
  return content_key("compare row 4|" + binary + '|' + tried.name + '|' + facts.content + '|' +
                     attempt.solver->name + '|' + attempt.solver->external_key + '|' +
                     name_of(options.measure) + '|' + name_of(attempt.start) + '|' + numbers);
}

/// One comparison under way.
class Comparison {
 public:
  Comparison(const std::vector<CompareCase>& cases, const CompareOptions& options,
             const CompareProgress& progress)
      : cases_(cases), options_(options), progress_(progress), binary_(binary_key()) {}

  std::vector<CompareRow> execute() {
    create_folder(options_.folder / "rows");
    Manifest manifest("compare", {options_.command}, binary_);
    count_ = cases_.size() * options_.tolerances.size() * options_.starts.size() *
             options_.solvers.size() * static_cast<size_t>(options_.repeats);
    for (int repeat = 0; repeat < options_.repeats && goes_on_; ++repeat)
      for (size_t c = 0; c < cases_.size() && goes_on_; ++c) try_case(cases_[c], repeat);
    write_whole_file(options_.folder / "results.csv", compare_csv(rows_));
    describe(manifest);
    manifest.write(options_.folder / "manifest.json");
    return std::move(rows_);
  }

 private:
  void try_case(const CompareCase& tried, int repeat) {
    const size_t planned =
        options_.tolerances.size() * options_.starts.size() * options_.solvers.size();
    if (unreadable_.contains(tried.name)) {
      done_ += planned;
      return;
    }
    LoadedCase loaded;
    try {
      loaded = tried.load();
    } catch (const std::exception& error) {
      done_ += planned;
      add_unreadable(tried, error.what());
      return;
    }
    look_for_exact(loaded);
    const std::vector<Attempt> attempts = attempts_of(options_, loaded);
    done_ += planned - attempts.size();
    for (const Attempt& attempt : attempts) {
      if (!goes_on_) return;
      ++done_;
      const std::string identity = tried.name + '|' + attempt.solver->name + '|' +
                                   name_of(attempt.start) + '|' + std::to_string(attempt.tolerance);
      if (repeat > 0 && unsolved_.contains(identity)) continue;
      bool was_there = false;
      CompareRow row = row_of(tried, loaded, attempt, repeat, was_there);
      if (row.verdict != Verdict::solved) unsolved_.insert(identity);
      goes_on_ = progress_(row, was_there, done_, count_);
      rows_.push_back(std::move(row));
    }
  }

  void look_for_exact(LoadedCase& loaded) const {
    const ExactSearch search{loaded.facts.velocity_scale, options_.exact_seconds,
                             options_.folder / "exact", loaded.facts.content};
    if (auto found = find_exact_answer(loaded.problem, loaded.warm_start, search))
      loaded.exact = std::move(found->impulses);
  }

  CompareRow blank_row(const CompareCase& tried) const {
    CompareRow row;
    row.case_name = tried.name;
    row.family = tried.family;
    row.measure = options_.measure;
    row.max_seconds = options_.max_seconds;
    return row;
  }

  /// One row for the case, whatever was to be tried on it. It has no file: the case may be mended.
  void add_unreadable(const CompareCase& tried, const std::string& why) {
    unreadable_.insert(tried.name);
    CompareRow row = blank_row(tried);
    row.verdict = Verdict::unreadable;
    row.note = why;
    goes_on_ = progress_(row, false, done_, count_);
    rows_.push_back(std::move(row));
  }

  /// The row that is there already; none when there is no file, or a damaged one.
  static std::optional<CompareRow> stored_row(const fs::path& file) {
    if (!is_there(file)) return std::nullopt;
    try {
      return compare_row_of_json(read_whole_file(file), file.string());
    } catch (const Error&) {
      return std::nullopt;
    }
  }

  CompareRow row_of(const CompareCase& tried, const LoadedCase& loaded, const Attempt& attempt,
                    int repeat, bool& was_there) const {
    CompareRow row = blank_row(tried);
    row.key = key_of(options_, binary_, tried, loaded.facts, attempt, repeat);
    const fs::path file = options_.folder / "rows" / (row.key + ".json");
    if (std::optional<CompareRow> stored = stored_row(file)) {
      was_there = true;
      row = std::move(*stored);
    }
    row.word = tried.word;
    row.can_view = tried.has_bodies && attempt.solver->external_key.empty();
    if (was_there) return row;
    row.solver = attempt.solver->name;
    row.law = name_of(attempt.solver->law);
    row.tolerance = attempt.tolerance;
    row.start = attempt.start;
    row.repeat = repeat;
    row.facts = loaded.facts;
    const auto solve = attempt.solver->external_key.empty() ? solve_in_child : solve_outside;
    solve(attempt.solver->make, loaded, options_.limits, row);
    // an interrupt reaches the child as well: what it left is no result
    if (!InterruptGuard::requested()) write_whole_file(file, to_json(row));
    return row;
  }

  void describe(Manifest& manifest) const {
    manifest.summary("rows", static_cast<double>(rows_.size()));
    manifest.summary("complete", goes_on_ ? "yes" : "no: stopped; the same command goes on");
    manifest.summary("measure", name_of(options_.measure));
    manifest.summary("max_seconds", options_.max_seconds);
    manifest.summary("memory_MB", options_.limits.memory_MB);
    manifest.summary("repeats", options_.repeats);
    manifest.summary("blas", loaded_blas());
    manifest.summary("unreadable_cases", static_cast<double>(unreadable_.size()));
    long solved = 0, denied = 0;
    for (const CompareRow& row : rows_) {
      solved += row.verdict == Verdict::solved;
      denied += row.verdict == Verdict::denied;
    }
    manifest.summary("solved", static_cast<double>(solved));
    manifest.summary("claims_that_the_judge_denies", static_cast<double>(denied));
  }

  const std::vector<CompareCase>& cases_;
  const CompareOptions& options_;
  const CompareProgress& progress_;
  std::string binary_;
  std::vector<CompareRow> rows_;
  std::set<std::string> unsolved_, unreadable_;
  size_t done_ = 0, count_ = 0;
  bool goes_on_ = true;
};

}  // namespace

std::vector<CompareRow> run_comparison(const std::vector<CompareCase>& cases,
                                       const CompareOptions& options,
                                       const CompareProgress& progress) {
  return Comparison(cases, options, progress).execute();
}

std::string binary_key() { return content_key(read_whole_file("/proc/self/exe")); }

std::string loaded_blas() {
  std::set<std::string> found;
  std::ifstream maps("/proc/self/maps");
  for (std::string line; std::getline(maps, line);) {
    const std::string name = line.substr(line.rfind('/') + 1);
    for (const char* beginning :
         {"libopenblas", "libblas", "liblapack", "libmkl", "libblis", "libatlas", "libcblas"})
      if (line.find('/') != std::string::npos && name.rfind(beginning, 0) == 0) found.insert(name);
  }
  return found.empty() ? "none" : joined(found);
}

}  // namespace ballast
