#include "experiments/compare/collection.hpp"

#include <algorithm>
#include <cctype>
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
#include "problems/scene/toml_reader.hpp"

namespace ballast {
namespace {

namespace fs = std::filesystem;

// The list of problems.

using Texts = std::vector<std::string>;

struct Entry {
  std::string name, scene, steps, part = "small";
  Texts set, made;
  std::vector<Texts> vary;
};

std::vector<Texts> read_vary(TomlTable& table) {
  table.know("vary");
  constexpr const char* expected = "expected lists of texts, [[\"a.key=1\", \"a.key=2\"]]";
  std::vector<Texts> axes;
  const toml::node* node = table.as_it_stands().get("vary");
  if (!node) return axes;
  if (!node->is_array()) table.fail("vary", expected);
  for (const toml::node& list : *node->as_array()) {
    Texts& axis = axes.emplace_back();
    if (!list.is_array() || list.as_array()->empty()) table.fail("vary", expected);
    for (const toml::node& text : *list.as_array()) {
      axis.push_back(text.is_string() ? text.as_string()->get() : "");
      const std::string first = split(axis.back(), ' ').front();  // it names the run
      if (first.find('=') == std::string::npos) table.fail("vary", expected);
    }
  }
  return axes;
}

Entry read_entry(TomlTable& table, const std::vector<Entry>& before) {
  const std::string name = table.text("name"), like = table.text("like", "");
  // A made problem's file begins with the name, from which a comparison takes its family.
  if (!is_plain(name, "_") || family_of_file(name) != name)
    table.fail("name", "\"" + name + "\": expected letters, digits and _, a letter last");
  Entry entry;
  if (!like.empty()) {
    const auto found = std::ranges::find(before, like, &Entry::name);
    if (found == before.end()) table.fail("like", "\"" + like + "\": no entry further up");
    entry = *found;
  }
  entry.name = name;
  entry.scene = table.text("scene", entry.scene);
  entry.steps = table.text("steps", entry.steps);
  entry.part = "small";
  table.read("part", &entry.part, one_of({"small", "large"}));
  for (std::string& text : table.texts("set")) entry.set.push_back(std::move(text));
  entry.made = table.texts("made");
  if (std::vector<Texts> axes = read_vary(table); !axes.empty()) entry.vary = std::move(axes);
  if (entry.scene.empty() == entry.made.empty())
    table.fail("scene", "expected either a scene or `made`, problems that are made");
  if (entry.made.empty() && entry.steps.empty()) table.text("steps");  // throws, as it is missing
  table.finish();
  return entry;
}

/// The part of a run's name for a text of `vary`: the value of the text's first override.
std::string label_of(const std::string& text) {
  std::string label;
  for (const char c : split(text, ' ').front().substr(text.find('=') + 1))
    if (std::isalnum(static_cast<unsigned char>(c)) || c == '.' || c == '-')
      label += c;
    else if (!label.empty() && label.back() != '_' && c != '"')
      label += '_';
  while (!label.empty() && label.back() == '_') label.pop_back();
  return label;
}

/// Adds a run for each combination; the last axis changes fastest.
void add_runs(const Entry& entry, size_t axis, CollectedRun run, std::vector<CollectedRun>& runs) {
  if (axis == entry.vary.size()) {
    const Scene scene = resolve_run(run.scene, run.overrides).scene;
    run.bodies = scene.grains ? scene.grains->count : static_cast<int>(scene.bodies.size());
    for (long step = 1; step <= scene.step_count(); ++step) run.steps += run.capture.takes(step);
    runs.push_back(std::move(run));
    return;
  }
  for (const std::string& text : entry.vary[axis]) {
    CollectedRun next = run;
    next.name += '-' + label_of(text);
    for (std::string& word : split(text, ' '))
      if (!word.empty()) next.overrides.push_back(std::move(word));
    add_runs(entry, axis + 1, std::move(next), runs);
  }
}

void add_entry(const Entry& entry, std::vector<CollectedRun>& runs) {
  CollectedRun run;
  run.family = run.name = entry.name;
  run.is_large = entry.part == "large";
  int number = 0;
  for (const std::string& word : entry.made) {
    compare_cases({word});  // throws for a wrong word
    run.made = word;
    run.name = entry.name + (run.is_large ? "-large-" : "-made-") + std::to_string(++number);
    runs.push_back(run);
  }
  if (!entry.made.empty()) return;
  run.scene = entry.scene;
  run.overrides = entry.set;
  run.capture = CaptureSettings::parse(entry.steps);
  add_runs(entry, 0, std::move(run), runs);
}

// The collection.

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

std::vector<CollectedRun> read_collection(const fs::path& file) {
  const toml::table raw = load_toml(file);
  toml::table resolved;
  TomlTable root(file.string(), raw, resolved);
  std::vector<Entry> entries;
  std::vector<CollectedRun> runs;
  for (TomlTable& table : root.sections("family")) {
    entries.push_back(read_entry(table, entries));
    try {
      add_entry(entries.back(), runs);
    } catch (const std::exception& error) {
      throw Error(file.string() + ": family " + entries.back().name + ": " + error.what());
    }
  }
  root.finish();
  std::set<std::string> names;
  for (const CollectedRun& run : runs)
    if (!names.insert(run.name).second)
      throw Error(file.string() + ": family " + run.family + ": " + run.name +
                  " stands twice: expected other values or another name");
  if (runs.empty()) throw Error(file.string() + ": expected tables [[family]]");
  return runs;
}

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
