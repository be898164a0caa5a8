// The command compare: runs backends on identical problems (rows, figures, a page), compares and
// merges such comparisons, and makes the collection of captured problems.

#include <algorithm>
#include <iostream>
#include <limits>
#include <map>
#include <memory>
#include <span>

#include "experiments/commands/command.hpp"
#include "experiments/compare/collection.hpp"
#include "experiments/compare/compare_page.hpp"
#include "experiments/compare/comparison.hpp"
#include "experiments/compare/live.hpp"
#include "experiments/compare/ranking.hpp"
#include "experiments/compare/stored_comparison.hpp"
#include "experiments/run/run.hpp"
#include "platform/atomic_file.hpp"
#include "platform/error.hpp"
#include "platform/interrupt.hpp"
#include "platform/program.hpp"
#include "platform/text.hpp"

namespace ballast {
namespace {

struct CollectOptions {
  CollectionOptions made{.folder = "results/collection"};
  std::filesystem::path list;
  std::string part = "small";
  int largest = 1'000'000;
};

ExitCode collect(const CollectOptions& options) {
  const std::filesystem::path& folder = options.made.folder;
  if (options.part != "small" && options.part != "all")
    throw UsageError("compare collect: --part " + options.part + ": expected small or all");
  require_own_folder(folder, {{"collection.toml", "family"}});
  create_folder(folder / "runs");
  const FileLock lock(folder / "collection.lock", briefly);
  lock.require_held();
  // The list that the collection is made from is kept with it.
  const std::filesystem::path kept = folder / "collection.toml";
  if (options.list.empty() && path_exists(kept) && read_whole_file(kept) != collection_list())
    throw Error(kept.string() + ": is another list than the built-in one: give it as --list");
  if (options.list.empty()) write_whole_file(kept, collection_list());
  std::vector<CollectedRun> runs = read_collection(options.list.empty() ? kept : options.list);
  if (!options.list.empty()) write_whole_file(kept, read_whole_file(options.list));
  std::erase_if(runs, [&](const CollectedRun& run) {
    return (run.is_large && options.part == "small") || run.bodies > options.largest;
  });
  size_t number = 0;
  const auto announce = [&](const CollectedRun& run) {
    std::cout << printed("%3zu/%zu  ", ++number, runs.size()) << run.name << std::endl;
  };
  const ExitCode code = make_collection(options.made, runs, announce);
  if (code != ExitCode::ok) {
    std::cerr << "ballast: compare collect: stopped; the same command goes on" << std::endl;
    return code;
  }
  std::cout << "made: " << (folder / "manifest.csv").string() << std::endl;
  return ExitCode::ok;
}

Command collect_command() {
  const auto options = std::make_shared<CollectOptions>();
  CollectionOptions& made = options->made;
  return {
      "collect",
      "Makes the collection of problems from many scenes, with a manifest and reference solutions",
      {{"--output DIR", &made.folder, "Folder of the collection; the same command continues it"},
       {"--part", &options->part, "small (up to some 1000 contacts: minutes) or all (hours)"},
       {"--largest", &options->largest, "Leaves out scenes of more grains or bodies", at_least(1)},
       {"--held", &made.keeps_held_apart,
        "Keeps the held-out fifth in held/, apart from the problems that methods may be tuned on"},
       {"--exact-seconds", &made.reference_seconds,
        "Wall clock [s] to find the reference solution of one problem; 0: no search", at_least(0)},
       {"--threads", &made.threads, "Threads of a run; the problems stay the same", at_least(1)},
       {"--list FILE", &options->list, "A list of your own instead of the built-in one"}},
      [options] { return collect(*options); }};
}

struct DiffOptions {
  std::filesystem::path before, after;
  double least = 1.1;
  bool shows_all = false;
};

/// Prints one line. `width` is that of the longest case's name.
void print_change(const ChangedSolve& solve, int width) {
  const bool has_both = solve.before > 0.0 && solve.after > 0.0;
  const std::string ratio = has_both ? printed("%.2f", solve.after / solve.before) : "-";
  std::cout << printed("%-*s %-14s %-8g%-6s%12.4g%12.4g%8s%8.2f  %s\n", width,
                       solve.row->case_name.c_str(), solve.row->solver.c_str(),
                       solve.row->tolerance, name_of(solve.row->start), solve.before, solve.after,
                       ratio.c_str(), solve.spread, name_of(solve.change));
}

ExitCode diff(const DiffOptions& options) {
  const StoredComparison before = read_comparison(options.before),
                         after = read_comparison(options.after);
  double least = options.least;
  if (before.machine != after.machine) {
    std::cout << "other machines (" << before.machine << "; " << after.machine
              << "): times are not compared\n";
    least = std::numeric_limits<double>::infinity();
  }
  const std::vector<ChangedSolve> changes = compare_diff(before.rows, after.rows, least);
  std::map<Change, int> counts;
  int width = 34;
  for (const ChangedSolve& solve : changes)
    width = std::max(width, static_cast<int>(solve.row->case_name.size()));
  std::cout << printed("%-*s %-14s %-8s%-6s%12s%12s%8s%8s  %s\n", width, "case", "solver", "tol",
                       "start", "before_s", "after_s", "ratio", "spread", "change");
  for (const ChangedSolve& solve : changes) {
    ++counts[solve.change];
    if (solve.change != Change::same || options.shows_all) print_change(solve, width);
  }
  std::string summary;
  for (const auto& [change, count] : counts)
    add_to_list(summary, std::to_string(count) + " " + name_of(change));
  std::cout << before.program << " -> " << after.program << ": " << summary << std::endl;
  const size_t alone = counts[Change::only_before] + counts[Change::only_after];
  if (changes.size() == alone) throw Error("compare diff: the two have no solve in common");
  if (counts[Change::lost] + counts[Change::slower] > 0)
    throw Error(printed("compare diff: %d solves are lost and %d slower", counts[Change::lost],
                        counts[Change::slower]));
  return ExitCode::ok;
}

Command compare_diff_command() {
  const auto options = std::make_shared<DiffOptions>();
  return {"diff",
          "Lists what changed between two comparisons; exit code 1 if a solve is slower or lost",
          {{"before", &options->before, "Folder of the earlier comparison", required},
           {"after", &options->after, "Folder of the later one, from the same machine", required},
           {"--least", &options->least,
            "Factor beyond which a median counts as changed, if also beyond the repeats' spread",
            at_least(1)},
           {"--all", &options->shows_all, "Also lists the solves that are the same"}},
          [options] { return diff(*options); }};
}

/// A command that makes one page of several comparisons with `write`.
Command merging_command(const char* name, const char* meaning, const char* output, const char* page,
                        void (*write)(const std::filesystem::path& folder,
                                      std::span<const CompareRow> rows)) {
  struct Options {
    std::vector<std::string> folders;
    std::filesystem::path output;
  };
  const auto options = std::make_shared<Options>();
  options->output = output;
  return {name,
          meaning,
          {{"folders", &options->folders, "Folders of comparisons", required},
           {"--output DIR", &options->output, "Folder of the page and its table"}},
          [=] {
            std::vector<StoredComparison> comparisons;
            for (const std::string& folder : options->folders)
              comparisons.push_back(read_comparison(folder));
            // Only the manifest of a merged comparison has an empty key.
            require_own_folder(options->output, {{"manifest.json", "\"key\": \"\""}});
            const std::vector<CompareRow> rows =
                write_origins(options->output, comparisons, own_command());
            write(options->output, rows);
            std::cout << comparisons.size() << " comparisons, " << rows.size()
                      << " rows: " << (options->output / page).string() << std::endl;
            return ExitCode::ok;
          }};
}

/// The values of the command line, and the options made from them.
struct CompareRequest {
  LiveOptions live;
  std::vector<std::string> cases, external;
  ExternalLimits program_limits;
  CompareOptions& comparison = live;
  bool report = true, is_quiet = false;
};

void show(const CompareRow& row, bool was_stored, size_t done, size_t count) {
  std::cout << printed("%5zu/%zu  %-34.34s ", done, count, row.case_name.c_str());
  if (row.verdict == Verdict::unreadable)
    std::cout << "unreadable: " << row.note;
  else
    std::cout << printed("%-14s %-6g %-4s %-13s %10.4g s  error %9.3g%s%s", row.solver.c_str(),
                         row.tolerance, name_of(row.start), name_of(row.verdict), row.seconds(),
                         row.error, was_stored ? "  (was there)" : "",
                         row.verdict == Verdict::denied ? "  JUDGE DISAGREES" : "")
              << (row.note.empty() ? "" : "  " + row.note);
  std::cout << std::endl;
}

constexpr const char* interrupted =
    "compare: interrupted; nothing is lost, the same command goes on";

/// Runs the closed loop under each backend.
ExitCode compare_live(CompareRequest& options) {
  LiveOptions& live = options.live;
  if (options.is_quiet) live.style = StatusLine::Style::quiet;
  const auto told = [&](const Trajectory& trajectory) {
    if (!options.is_quiet)
      std::cout << trajectory.label() << ": " << trajectory.steps.size() << " steps, "
                << trajectory.ended << std::endl;
  };
  Manifest manifest("compare --live " + live.scene, {options.comparison.command}, binary_key());
  manifest.summary("blas", loaded_blas());
  manifest.write(live.folder / "manifest.json");  // it identifies the folder
  const LiveComparison comparison = run_live(live, told);
  if (InterruptGuard::requested()) throw Error(interrupted);
  write_live_page(live.folder, comparison);
  if (options.is_quiet) return ExitCode::ok;
  std::cout << "\nresults in " << live.folder.string()
            << "\n  live.html   figures and the table: open it in a browser\n"
            << "  live.csv    one row per trajectory; steps-*.csv: every step's scalars"
            << std::endl;
  return ExitCode::ok;
}

/// Throws Error with the reasons of the cases that could not be read.
void require_readable(std::span<const CompareRow> rows, size_t cases) {
  std::vector<std::string> reasons;
  for (const CompareRow& row : rows)
    if (row.verdict == Verdict::unreadable) reasons.push_back(row.note);
  if (!reasons.empty())
    throw Error(printed("compare: %zu of %zu cases could not be read: ", reasons.size(), cases) +
                joined(reasons));
}

ExitCode compare(CompareRequest& options) {
  if (options.cases.empty() == options.live.scene.empty())
    throw UsageError(options.cases.empty() ? "compare: expected cases, or --live SCENE"
                                           : "compare: --live SCENE: not with cases");
  if (options.comparison.tolerances.empty() && options.live.iterations.empty())
    throw UsageError("compare: --tolerances none: expected --live SCENE --iterations COUNT");
  const bool is_live = !options.live.scene.empty();
  if (options.comparison.folder.empty())
    options.comparison.folder = is_live ? "results/compare_live" : "results/compare";
  const std::filesystem::path output = options.comparison.folder;
  require_own_folder(output, {{"manifest.json", is_live ? "\"scene\": \"compare --live"
                                                        : "\"scene\": \"compare\""}});
  if (RunFolder(output).has_run())  // the run of a scene called compare
    throw Error(output.string() + ": holds a run: give a folder that is new or empty");
  restart_with_one_algebra_thread();
  options.program_limits.memory_MB = options.comparison.limits.memory_MB;
  std::vector<ComparedSolver> programs;
  try {
    programs = external_solvers(options.external, options.program_limits);
  } catch (const std::invalid_argument& error) {
    throw UsageError(std::string("compare: --external: ") + error.what());
  }
  for (ComparedSolver& program : programs) options.comparison.solvers.push_back(std::move(program));
  if (options.comparison.solvers.empty())
    throw UsageError("compare: --solvers none: expected a program that solves, --external");
  options.comparison.command = own_command();
  // A word that names no case or scene throws before a folder is made.
  if (is_live) resolve_run(options.live.scene, options.live.overrides);
  const std::vector<CompareCase> cases = compare_cases(options.cases);
  create_folder(output);
  const FileLock lock(output / "compare.lock", briefly);
  lock.require_held();
  if (is_live) return compare_live(options);
  std::filesystem::remove(output / "results.csv");  // left by an earlier command with its manifest
  const InterruptGuard guard;
  // Destroyed before `guard`: the programs and their folders go while SIGPIPE is still ignored.
  const CompareOptions comparison = std::exchange(options.comparison, {});
  const auto told = [&](const CompareRow& row, bool was_stored, size_t done, size_t count) {
    if (!options.is_quiet) show(row, was_stored, done, count);
  };
  const std::vector<CompareRow> rows = run_comparison(cases, comparison, told);
  if (InterruptGuard::requested()) throw Error(interrupted);
  if (options.report) write_compare_page(output, rows);
  if (!options.is_quiet)
    std::cout << '\n'
              << compare_summary(rows) << "\nresults in " << output.string() << "\n"
              << (options.report ? "  compare.html  figures and tables: open it in a browser\n"
                                 : "")
              << "  results.csv   one row per solve; rows/*.json: the same with their histories\n"
              << "  manifest.json program, machine, BLAS, options" << std::endl;
  require_readable(rows, cases.size());
  return ExitCode::ok;
}

/// The cases and, before the words that exclude --live, those that need it.
std::vector<Word> words_of(CompareRequest& options) {
  LiveOptions& live = options.live;
  CompareOptions& comparison = options.comparison;
  const Rule not_live = excludes("--live");  // whose solvers work inside the step
  return {
      {"cases", &options.cases, "Files, folders, patterns, known:..., pile:..., stress:..."},
      {"--live SCENE", &live.scene,
       "Instead of cases: simulates a scene from one start with each backend and tolerance"},
      {"--set KEY=VALUE", &live.overrides, "Overrides one value of that scene: dotted.key=value",
       needs("--live")},
      {"--from", &live.start,
       "Simulated time [s] of that start; the scene's own solver runs up to it, once for all",
       at_least(0), needs("--live")},
      {"--duration", &live.duration, "Simulated time [s] from that start on", above(0),
       needs("--live")},
      {"--iterations", &live.iterations,
       "Adds trajectories of so many iterations in every step, comma-separated", at_least(1),
       needs("--live")},
      {"--threads", &live.threads, "Threads of step and solver", between(1, 256), needs("--live")},
      {"--trajectory-seconds", &live.trajectory_seconds,
       "Limit on the wall clock of one trajectory [s]", above(0), needs("--live")},
      {"--packing-cache DIR", &live.packing_cache,
       "Where deposited packings are kept (default: <output>/packings)", needs("--live")},
      {"--solvers", into(comparison.solvers, parse_solvers, "all"),
       "Names of backends, separated by commas; all; or none (external programs alone)"},
      {"--external NAME=COMMAND", &options.external,
       "Adds a program that solves, or FILE.toml with a list of them (docs/manual/external.md)",
       not_live},
      {"--startup-seconds", &options.program_limits.startup_seconds,
       "Wall clock [s] for such a program to start and read, besides --max-seconds", at_least(0),
       not_live},
      {"--tolerances", into(comparison.tolerances, parse_tolerances, "1e-4,1e-8"),
       "Bounds on the error, separated by commas; none: only --live with --iterations"},
      {"--starts", into(comparison.starts, parse_starts, "cold"),
       "cold (from zero), warm (only cases that have a warm start) or cold,warm", not_live},
      {"--measure", into(comparison.measure, measure_of, "natural_map"),
       "The error that the tolerances bound: natural_map or fclib (see below)", not_live},
      {"--repeats", &comparison.repeats, "Interleaved repeats; tables show medians", at_least(1),
       not_live},
      {"--max-seconds", &comparison.max_seconds,
       "Limit on the wall clock of one solve, preparation included [s]", above(0)},
      {"--exact-seconds", &comparison.exact_seconds,
       "Wall clock [s] to find each case's solution at 1e-9, for distances from it; 0: no search",
       at_least(0), not_live},
      {"--memory", &comparison.limits.memory_MB,
       "Limit on the address space of one child process [MB]; 0: no limit", at_least(0), not_live},
      {"--output DIR", &comparison.folder,
       "Folder of the results (default: results/compare; with --live results/compare_live)"},
      {"--no-report", &options.report, "Draws no figures and no page", not_live},
      {"--quiet", &options.is_quiet, "Prints nothing but failures"}};
}

}  // namespace

Command compare_command() {
  const auto options = std::make_shared<CompareRequest>();
  options->comparison.exact_seconds = 5.0;
  return {
      "compare",
      "Compares backends (solvers) on identical problems: accuracy against cost, figures, a page",
      words_of(*options),
      [options] { return compare(*options); },
      {compare_diff_command(),
       merging_command("merge",
                       "Merges comparisons of jobs, machines or days; ratios only within a machine",
                       "results/merged", "compare.html", write_merged),
       merging_command("ranking", "Ranks backends: what each solves, how fast; a page and a table",
                       "results/ranking", "index.html", write_ranking),
       collect_command()}};
}

}  // namespace ballast
