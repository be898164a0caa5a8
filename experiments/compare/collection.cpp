#include "experiments/compare/collection.hpp"

#include <algorithm>
#include <cmath>
#include <set>

#include "experiments/compare/compare_case.hpp"
#include "experiments/compare/comparison.hpp"
#include "experiments/run/run.hpp"
#include "platform/atomic_file.hpp"
#include "platform/csv.hpp"
#include "platform/error.hpp"
#include "platform/hdf5_file.hpp"
#include "platform/interrupt.hpp"
#include "platform/random.hpp"
#include "platform/text.hpp"
#include "problems/algebra/contact_error.hpp"
#include "problems/files/captured_problem.hpp"
#include "problems/files/problem_file.hpp"

namespace ballast {
namespace {

namespace fs = std::filesystem;

/// Rounds entries to single precision, so that the last bit of a machine's sines and powers is not
/// in the problem. A mass block stays symmetric positive definite.
void round_entries(DynamicsForm& dynamics) {
  const auto round = [](auto& values) {
    for (double& value : values) value = static_cast<double>(static_cast<float>(value));
  };
  round(dynamics.mass);
  round(dynamics.h);
  round(dynamics.v_free);
  round(dynamics.bias);
}

/// A name whose family_of_file() is the family: "pile-c100-d0.3-R1-f0.3..0.3-a0.8-s1.hdf5".
std::string made_name(const std::string& family, const std::string& case_name) {
  const std::string rest = case_name.substr(std::min(case_name.find('-'), case_name.size()));
  return made_plain(family + rest, "-._=+") + ".hdf5";
}

/// One collection while it is made.
class Collection {
 public:
  explicit Collection(const CollectionOptions& options) : options_(options) {
    manifest_.add_row(std::vector<std::string>{
        "file", "family", "held", "content", "contacts", "rows", "bodies", "rank_deficiency",
        "mass_ratio", "friction_min", "friction_max", "step", "phase", "warm_error"});
    references_.add_row(std::vector<std::string>{"file", "exact", "error", "backend"});
  }

  ExitCode add(const CollectedRun& wanted) {
    const fs::path source = options_.folder / "runs" / wanted.name;
    const bool is_made = wanted.scene.empty();
    const fs::path problems = source / (is_made ? "problems" : "capture");
    if (is_made)
      make_problems(wanted, problems);
    else if (const ExitCode code = run_scene(wanted, source); code != ExitCode::ok)
      return code;
    if (!is_folder(problems)) return ExitCode::ok;
    const std::string label = wanted.name.substr(wanted.family.size());  // "-25-1"
    const std::vector<FoundProblem> all = find_problems(problems.string());
    if (!is_made && static_cast<long>(all.size()) != wanted.steps)
      throw Error(source.string() + printed(": has %zu steps, the list asks for %ld: remove it",
                                            all.size(), wanted.steps));
    for (const FoundProblem& found : all) {
      std::string name = found.name.string();
      if (!is_made && !label.empty()) name = label.substr(1) + '-' + name;
      keep(wanted.family, name, found.file);
      if (InterruptGuard::requested()) return ExitCode::failure;
    }
    return ExitCode::ok;
  }

  void write() {
    write_whole_file(options_.folder / "manifest.csv", manifest_.take());
    write_whole_file(options_.folder / "references.csv", references_.take());
  }

 private:
  ExitCode run_scene(const CollectedRun& wanted, const fs::path& folder) const {
    RunOptions running;
    running.scene = wanted.scene;
    running.overrides = wanted.overrides;
    running.output = folder;
    running.packing_cache = options_.folder / "packings";
    running.resume = true;
    running.capture = wanted.capture;
    running.threads = options_.threads;
    running.style = StatusLine::Style::quiet;
    return run(running).code;
  }

  /// Writes the problems; those of an earlier list go.
  static void make_problems(const CollectedRun& wanted, const fs::path& folder) {
    std::set<fs::path> made_here;
    for (const CompareCase& made : compare_cases({wanted.made})) {
      const fs::path file = folder / made_name(wanted.family, made.name);
      FrictionProblem problem = made.load().problem;
      if (!problem.has_dynamics || problem.contact_count() == 0) continue;
      problem.has_delassus = false;
      round_entries(problem.dynamics);
      create_folder(folder);
      write_problem(file, problem);
      made_here.insert(file);
    }
    if (!made_here.empty())
      for (const FoundProblem& found : find_problems(folder.string()))
        if (!made_here.contains(found.file)) fs::remove(found.file);
  }

  /// Copies a problem to its place, adds it to the manifest and looks for its reference.
  void keep(const std::string& family, const std::string& name, const fs::path& source) {
    const LoadedCase loaded = compare_cases({source.string()}).front().load();
    if (loaded.facts.contacts == 0 || !contents_.insert(loaded.facts.content).second) return;
    if (!names_.insert(fs::path(family) / name).second)
      throw Error("compare collect: family " + family + " has two problems of the name " + name +
                  ": give one of them a family of its own");
    const bool held = is_held(loaded.facts.content), apart = held && options_.keeps_held_apart;
    const fs::path place = fs::path(family) / name,
                   file = options_.folder / (apart ? "held" : "problems") / place,
                   other = options_.folder / (apart ? "problems" : "held") / place;
    create_folder(file.parent_path());
    fs::remove(other);  // left from another keeps_held_apart
    if (const std::string bytes = read_whole_file(source);
        !path_exists(file) || read_whole_file(file) != bytes) {
      fs::remove(reference_of(file));  // belongs to another problem
      write_whole_file(file, bytes);
    }
    note(place.string(), family, held, source, loaded);
    if (options_.reference_seconds > 0.0) refer(place.string(), file, loaded);
  }

  /// Adds a line to the manifest.
  void note(const std::string& name, const std::string& family, bool held, const fs::path& source,
            const LoadedCase& loaded) {
    const FrictionProblem& problem = loaded.problem;
    const CaseFacts& facts = loaded.facts;
    std::string step, phase = "made";
    if (is_captured(source)) {
      const CapturedProblem captured = read_captured(source);
      step = std::to_string(captured.step);
      phase = captured.phase;
    }
    const double warm_error =
        loaded.warm_start.size() == 0
            ? std::nan("")
            : contact_error(problem, loaded.warm_start).natural_map_rms / facts.velocity_scale;
    const auto friction = std::ranges::minmax(problem.friction);
    manifest_.add_row(std::vector<std::string>{
        name, family, held ? "1" : "0", facts.content, std::to_string(facts.contacts),
        std::to_string(facts.rows), std::to_string(problem.dynamics.body_count()),
        printed("%.4f", facts.rank_deficiency), number_cell(facts.mass_ratio, 6),
        number_cell(friction.min, 6), number_cell(friction.max, 6), step, phase,
        number_cell(warm_error, 6)});
  }

  /// Finds the reference unless a stored one is exact or had as much time, and adds it to
  /// references.csv. An interrupted search gives no result.
  void refer(const std::string& name, const fs::path& file, const LoadedCase& loaded) {
    const fs::path answer = reference_of(file);
    Reference known;
    double had = 0.0;  // time limit of the stored reference [s]
    if (path_exists(answer)) {
      const Hdf5Reader kept(answer);
      const auto number = [&](const char* entry) {
        return kept.read<double>(std::string("/ballast_answer/") + entry).at(0);
      };
      known.error = number("error");
      known.is_exact = number("exact") != 0.0;
      known.solver = kept.read_text("/ballast_answer/backend");
      had = number("reference_seconds");
    }
    if (!known.is_exact && had < options_.reference_seconds) {
      known = find_reference(loaded, options_.reference_seconds);
      if (InterruptGuard::requested()) return;
      create_folder(answer.parent_path());
      write_solution(answer, loaded.problem,
                     {known.impulses,
                      {{"error", known.error},
                       {"exact", known.is_exact},
                       {"reference_seconds", options_.reference_seconds}},
                      {{"backend", known.solver}}});
    }
    references_.add_row(std::vector<std::string>{name, known.is_exact ? "1" : "0",
                                                 printed("%.3g", known.error), known.solver});
  }

  const CollectionOptions& options_;
  CsvWriter manifest_, references_;
  std::set<std::string> contents_;  ///< of the kept problems: each is kept once
  std::set<fs::path> names_;        ///< family/file of the kept problems
};

}  // namespace

bool is_held(const std::string& content) {
  return SplitMix64(fnv1a("held|" + content)).below(5) == 0;
}

ExitCode make_collection(const CollectionOptions& options, std::span<const CollectedRun> runs,
                         const std::function<void(const CollectedRun&)>& told) {
  const InterruptGuard guard;
  Collection collection(options);
  for (const CollectedRun& wanted : runs) {
    told(wanted);
    if (const ExitCode code = collection.add(wanted); code != ExitCode::ok) return code;
  }
  collection.write();
  return ExitCode::ok;
}

}  // namespace ballast
