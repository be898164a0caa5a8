#include "experiments/compare/comparison.hpp"

#include <algorithm>
#include <fstream>
#include <map>
#include <set>
#include <stdexcept>
#include <utility>

#include "experiments/run/run_folder.hpp"
#include "platform/atomic_file.hpp"
#include "platform/error.hpp"
#include "platform/interrupt.hpp"
#include "platform/program.hpp"
#include "platform/text.hpp"
#include "solvers/solver_list.hpp"

namespace ballast {
namespace {

constexpr double exact_tolerance = 1e-9;

bool is_exact(const LoadedCase& loaded) {
  return loaded.exact.size() == loaded.problem.row_count() && loaded.exact.allFinite() &&
         contact_error(loaded.problem, loaded.exact)
             .within(exact_tolerance * loaded.facts.velocity_scale);
}

/// Impulses as bytes, for a child's answer or a file. No check sum: the reader judges them again.
std::string bytes_of(const Impulses& impulses) {
  return {reinterpret_cast<const char*>(impulses.data()),
          sizeof(double) * static_cast<size_t>(impulses.size())};
}

Impulses impulses_of(const std::string& bytes) {
  Impulses impulses(static_cast<Eigen::Index>(bytes.size() / sizeof(double)));
  std::copy_n(bytes.data(), sizeof(double) * static_cast<size_t>(impulses.size()),
              reinterpret_cast<char*>(impulses.data()));
  return impulses;
}

namespace fs = std::filesystem;

/// One comparison while it runs.
class Comparison {
 public:
  Comparison(const std::vector<CompareCase>& cases, const CompareOptions& options,
             const CompareProgress& progress)
      : cases_(cases), options_(options), progress_(progress), binary_(binary_key()) {}

  std::vector<CompareRow> execute() {
    Manifest manifest("compare", {options_.command}, binary_);
    manifest.summary("complete", "no: under way");
    manifest.write(options_.folder / "manifest.json");  // identifies the folder
    create_folder(options_.folder / "rows");
    count_ = cases_.size() * options_.tolerances.size() * options_.starts.size() *
             options_.solvers.size() * static_cast<size_t>(options_.repeats);
    for (int repeat = 0; repeat < options_.repeats; ++repeat)
      for (const CompareCase& tried : cases_)
        if (!InterruptGuard::requested()) try_case(tried, repeat);
    write_whole_file(options_.folder / "results.csv", compare_csv(rows_));
    describe(manifest);
    manifest.write(options_.folder / "manifest.json");
    return std::move(rows_);
  }

 private:
  void try_case(const CompareCase& tried, int repeat) {
    const size_t pairs = options_.tolerances.size() * options_.solvers.size();
    std::vector<StartKind> starts = options_.starts;
    // An unreadable case has one row, whatever is to be tried, and no file: it may be mended.
    if (unreadable_.contains(tried.name)) {
      done_ += pairs * starts.size();
      return;
    }
    CompareRow row;
    row.case_name = tried.name;
    row.family = tried.family;
    row.measure = options_.measure;
    row.max_seconds = options_.max_seconds;
    row.repeat = repeat;
    row.word = tried.word;
    LoadedCase loaded;
    try {
      loaded = tried.load();
    } catch (const std::exception& error) {
      unreadable_.insert(tried.name);
      done_ += pairs * starts.size();
      row.verdict = Verdict::unreadable;
      row.note = error.what();
      return add(std::move(row), false);
    }
    if (loaded.warm_start.size() == 0) std::erase(starts, StartKind::warm);
    done_ += pairs * (options_.starts.size() - starts.size());
    if (starts.empty()) return;
    find_exact(loaded, options_.exact_seconds, options_.folder / "exact");
    row.facts = loaded.facts;
    for (const double tolerance : options_.tolerances)
      for (const StartKind start : starts)
        for (const ComparedSolver& solver : options_.solvers) {
          if (InterruptGuard::requested()) return;
          ++done_;
          row.solver = solver.name;
          row.law = name_of(solver.law);
          row.tolerance = tolerance;
          row.start = start;
          row.can_view = tried.has_bodies && solver.external_key.empty();
          attempt(loaded, solver, row);
        }
  }

  void add(CompareRow row, bool was_stored) {
    progress_(row, was_stored, done_, count_);
    rows_.push_back(std::move(row));
  }

  std::string key_of(const CompareRow& row, const ComparedSolver& solver) const {
    const SolveLimits& limits = options_.limits;
    const std::string numbers =
        printed("%.17g %.17g %.17g %d %.17g %.17g %d %d", row.tolerance, row.max_seconds,
                options_.exact_seconds, limits.max_iterations, limits.memory_MB,
                limits.min_timing_seconds, limits.most_runs, row.repeat);
    return content_key("compare row 4|" + binary_ + '|' + row.case_name + '|' + row.facts.content +
                       '|' + row.solver + '|' + solver.external_key + '|' + name_of(row.measure) +
                       '|' + name_of(row.start) + '|' + numbers);
  }

  /// The row of a tighter tolerance than one that took all the time: a copy of that, with a note.
  static CompareRow late_row(CompareRow looser, const CompareRow& row) {
    looser.note = not_tried + printed("out of time to %g already", looser.tolerance);
    looser.key = row.key;
    looser.tolerance = row.tolerance;
    return looser;
  }

  /// Adds the stored row, or solves the case and stores it. Unsolved attempts are not repeated.
  void attempt(const LoadedCase& loaded, const ComparedSolver& solver, CompareRow row) {
    const std::string who = row.case_name + '|' + row.solver + '|' + name_of(row.start);
    const std::string identity = who + '|' + printed("%.17g", row.tolerance);
    if (row.repeat > 0 && unsolved_.contains(identity)) return;
    row.key = key_of(row, solver);
    const fs::path file = options_.folder / "rows" / (row.key + ".json");
    const bool was_stored = take_stored(file, row);
    if (!was_stored) {
      const auto looser = late_.find(who);
      if (looser != late_.end() && looser->second.tolerance > row.tolerance)
        row = late_row(looser->second, row);
      else
        solve_case(solver, loaded, options_.limits, row);
      // an interrupt reaches the child as well, so its answer is no result
      if (InterruptGuard::requested()) return;
      write_whole_file(file, to_json(row));
    }
    if (row.verdict != Verdict::solved) unsolved_.insert(identity);
    if (row.verdict == Verdict::timeout) late_.emplace(who, row);
    add(std::move(row), was_stored);
  }

  /// Returns false where the file is missing, damaged or of another row.
  static bool take_stored(const fs::path& file, CompareRow& row) {
    try {
      CompareRow stored = compare_row_of_json(read_whole_file(file), file.string(), row);
      if (stored.key != row.key) return false;
      row = std::move(stored);
    } catch (const Error&) {
      return false;
    }
    return true;
  }

  void describe(Manifest& manifest) const {
    manifest.summary("rows", static_cast<double>(rows_.size()));
    manifest.summary("complete",
                     InterruptGuard::requested() ? "no: stopped; the same command goes on" : "yes");
    manifest.summary("measure", name_of(options_.measure));
    manifest.summary("max_seconds", options_.max_seconds);
    manifest.summary("memory_MB", options_.limits.memory_MB);
    manifest.summary("repeats", options_.repeats);
    manifest.summary("blas", loaded_blas());
    manifest.summary("unreadable_cases", static_cast<double>(unreadable_.size()));
    const auto count = [&](Verdict verdict) {
      return static_cast<double>(std::ranges::count(rows_, verdict, &CompareRow::verdict));
    };
    manifest.summary("solved", count(Verdict::solved));
    manifest.summary("claims_that_the_judge_denies", count(Verdict::denied));
  }

  const std::vector<CompareCase>& cases_;
  const CompareOptions& options_;
  const CompareProgress& progress_;
  std::string binary_;
  std::vector<CompareRow> rows_;
  std::set<std::string> unsolved_, unreadable_;
  std::map<std::string, CompareRow> late_;  ///< the loosest timeout of a case, backend and start
  size_t done_ = 0, count_ = 0;
};

}  // namespace

Reference find_reference(const LoadedCase& loaded, double max_seconds) {
  Reference best;
  const auto look_at = [&](Impulses impulses, const char* solver) {
    if (impulses.size() != loaded.problem.row_count() || !impulses.allFinite()) return;
    const ContactError error = contact_error(loaded.problem, impulses);
    const double size = error.natural_map_rms / loaded.facts.velocity_scale;
    const bool is_exact = error.within(exact_tolerance * loaded.facts.velocity_scale);
    if (best.solver.empty() || is_exact || size < best.error)
      best = {std::move(impulses), size, is_exact, solver};
  };
  look_at(Impulses::Zero(loaded.problem.row_count()), "start");
  look_at(loaded.warm_start, "start");
  const Budget budget{.tolerance = exact_tolerance * loaded.facts.velocity_scale,
                      .max_iterations = 1 << 30,
                      .max_seconds = 0.5 * max_seconds};
  for (const char* solver : {"newton_burst", "auto"}) {
    if (best.is_exact) break;
    const ChildResult child = run_in_child(1.25 * budget.max_seconds + 2.0, [&] {
      return bytes_of(SolverRunner()
                          .run(*make_solver(solver), loaded.problem, loaded.warm_start, budget)
                          .solved.impulses);
    });
    if (child.end == ChildEnd::complete) look_at(impulses_of(child.answer), solver);
  }
  return best;
}

void find_exact(LoadedCase& loaded, double max_seconds, const fs::path& folder) {
  if (is_exact(loaded)) return;
  loaded.exact.resize(0);
  if (!(max_seconds > 0.0)) return;
  const fs::path file = folder / (loaded.facts.content + ".exact");
  if (path_exists(file)) loaded.exact = impulses_of(read_whole_file(file));
  if (is_exact(loaded)) return;
  const Reference found = find_reference(loaded, max_seconds);
  loaded.exact = found.is_exact ? found.impulses : Impulses();
  if (!found.is_exact) return;
  create_folder(folder);
  write_whole_file(file, bytes_of(loaded.exact));
}

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

std::vector<ComparedSolver> parse_solvers(const std::string& list) {
  std::vector<ComparedSolver> solvers;
  if (list == "none") return solvers;
  if (list == "all") {
    for (const SolverEntry& entry : solver_list())
      if (entry.make) solvers.push_back({entry.name, entry.law, entry.make});
    return solvers;
  }
  for (const std::string& name : split(list, ',')) {
    make_solver(name);  // throws for a wrong name
    const SolverEntry& entry = find_solver(name);
    if (std::ranges::find(solvers, name, &ComparedSolver::name) == solvers.end())
      solvers.push_back({entry.name, entry.law, entry.make});
  }
  return solvers;
}

std::vector<ComparedSolver> external_solvers(const std::vector<std::string>& words,
                                             const ExternalLimits& limits) {
  std::vector<ComparedSolver> solvers;
  for (const ExternalCommand& command : external_commands(words)) {
    for (const SolverEntry& entry : solver_list())
      if (command.name == entry.name)
        throw std::invalid_argument(command.name + ": is the name of one of Ballast's solvers");
    solvers.push_back(
        {command.name, ContactLaw::coulomb, external_solver(command, limits), key_of(command)});
  }
  return solvers;
}

std::vector<double> parse_tolerances(const std::string& list) {
  if (list == "none") return {};
  std::set<double, std::greater<>> tolerances;
  for (const std::string& word : split(list, ',')) {
    const double value = parsed<double>(word).value_or(-1.0);
    if (!(value > 0.0) || !std::isfinite(value))
      throw std::invalid_argument("'" + word + "': expected a number > 0");
    tolerances.insert(value);
  }
  return {tolerances.begin(), tolerances.end()};
}

std::vector<StartKind> parse_starts(const std::string& list) {
  std::vector<StartKind> starts;
  for (const std::string& word : split(list, ','))
    if (const StartKind start = start_of(word); std::ranges::find(starts, start) == starts.end())
      starts.push_back(start);
  return starts;
}

}  // namespace ballast
