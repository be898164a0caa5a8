// Backends on identical problems: rows, figures and a page.

#include <cmath>
#include <iostream>
#include <memory>

#include <nlohmann/json.hpp>

#include "experiments/commands/command.hpp"
#include "experiments/commands/compare_snakemake.hpp"
#include "experiments/compare/backend_summary.hpp"
#include "experiments/compare/case_views.hpp"
#include "experiments/compare/compare_options.hpp"
#include "experiments/compare/compare_page.hpp"
#include "experiments/compare/live_page.hpp"
#include "experiments/compare/reference_times.hpp"
#include "experiments/run/manifest.hpp"
#include "platform/atomic_file.hpp"
#include "platform/error.hpp"
#include "platform/interrupt.hpp"
#include "platform/program.hpp"
#include "platform/text.hpp"
#include "solvers/solver_list.hpp"

namespace ballast {

// Each is defined in the file of its name.
Command compare_diff_command(), compare_merge_command(), compare_collect_command();

namespace {

/// The words of the command line, and what is made of them.
struct CompareRequest {
  LiveOptions live;
  std::vector<std::string> cases, external;
  ExternalLimits program_limits;
  bool with_views = false;
  std::string solvers = "all", tolerances = "1e-4,1e-8", starts = "cold", measure = "natural_map";
  std::filesystem::path output = "results/compare", reference;
  CompareOptions comparison;
  bool report = true, is_quiet = false, is_json = false;
  std::filesystem::path snakemake;

  Telling telling() const {
    return is_json ? Telling::program : is_quiet ? Telling::nobody : Telling::reader;
  }
};

using Json = nlohmann::ordered_json;

void tell(const Json& line) {
  std::cout << line.dump(-1, ' ', false, Json::error_handler_t::replace) << std::endl;
}

/// A row for a program: as its file has it, without the history.
bool tell_row(const CompareRow& row, bool was_there, size_t done, size_t count) {
  Json line = {{"event", "row"}, {"done", done}, {"count", count}, {"was_there", was_there}};
  line.update(Json::parse(to_json(row)));
  line.erase("history");
  tell(line);
  return !InterruptGuard::requested();
}

bool show(const CompareRow& row, bool was_there, size_t done, size_t count) {
  if (row.verdict == Verdict::unreadable) {
    std::cout << printed("%5zu/%zu  %-34.34s unreadable: ", done, count, row.case_name.c_str())
              << row.note << std::endl;
    return !InterruptGuard::requested();
  }
  std::cout << printed("%5zu/%zu  %-34.34s %-14s %-6g %-4s %-13s %10.4g s  error %9.3g%s%s", done,
                       count, row.case_name.c_str(), row.solver.c_str(), row.tolerance,
                       name_of(row.start), name_of(row.verdict), row.seconds(), row.error,
                       was_there ? "  (was there)" : "",
                       row.verdict == Verdict::denied ? "  JUDGE DISAGREES" : "")
            << (std::isnan(row.error) && !row.note.empty() ? "  " + row.note : "") << std::endl;
  return !InterruptGuard::requested();
}

std::vector<ComparedSolver> solvers_or_none(const std::string& list) {
  return list == "none" ? std::vector<ComparedSolver>() : parse_solvers(list);
}

ExitCode interrupted() {
  std::cerr << "ballast: compare: interrupted; nothing is lost, the same command goes on"
            << std::endl;
  return ExitCode::failure;
}

/// All cases could be read: ok. Otherwise one line with the reasons.
ExitCode verdict_on_cases(const std::vector<CompareRow>& rows, size_t cases) {
  std::string reasons;
  size_t count = 0;
  for (const CompareRow& row : rows) {
    if (row.verdict != Verdict::unreadable) continue;
    ++count;
    reasons += (reasons.empty() ? "" : "; ") + row.note;
  }
  if (count == 0) return ExitCode::ok;
  std::cerr << "ballast: compare: " << count << " of " << cases
            << " cases could not be read: " << reasons << std::endl;
  return ExitCode::failure;
}

bool show_trajectory(const Trajectory& trajectory) {
  std::cout << trajectory.label() << ": " << trajectory.steps.size() << " steps, "
            << trajectory.ended << std::endl;
  return !InterruptGuard::requested();
}

/// The closed loop under each backend.
ExitCode compare_live(const CompareRequest& options) {
  LiveOptions live = options.live;
  live.solvers = options.comparison.solvers;
  live.tolerances = options.comparison.tolerances;
  live.max_seconds = options.comparison.max_seconds;
  live.folder = options.output;
  live.telling = options.telling();
  const auto told = [&](const Trajectory& trajectory) {
    if (live.telling == Telling::reader) return show_trajectory(trajectory);
    if (live.telling == Telling::program)
      tell({{"event", "trajectory"},
            {"solver", trajectory.solver},
            {"tolerance", trajectory.tolerance},
            {"steps", trajectory.steps.size()},
            {"ended", trajectory.ended}});
    return !InterruptGuard::requested();
  };
  const LiveComparison comparison = run_live(live, told);
  if (InterruptGuard::requested()) return interrupted();
  Manifest manifest("compare --live " + live.scene, {options.comparison.command}, binary_key());
  manifest.summary("blas", loaded_blas());
  manifest.write(options.output / "manifest.json");
  write_live_page(options.output, comparison);
  if (live.telling == Telling::program)
    tell({{"event", "end"}, {"folder", options.output.string()}, {"exit_code", 0}});
  if (live.telling != Telling::reader) return ExitCode::ok;
  std::cout << "\nresults in " << options.output.string()
            << "\n  live.html   figures and the table: open it in a browser\n"
            << "  live.csv    one row per trajectory; steps-*.csv: every step's scalars"
            << std::endl;
  return ExitCode::ok;
}

/// The comparison as jobs for others; solves nothing.
ExitCode plan_jobs(const CompareRequest& options) {
  if (!options.live.scene.empty())
    throw UsageError(
        "compare: --snakemake: not with --live, whose trajectories go on from one start in one "
        "process; for closed loops on a cluster vary solver.name in `ballast plan --snakemake`");
  const CompareOptions& c = options.comparison;
  ComparisonPlan plan{
      .cases = options.cases,
      .solvers = {},
      .external = options.external,
      .options = {"--tolerances", options.tolerances, "--starts", options.starts, "--measure",
                  options.measure, "--repeats", std::to_string(c.repeats), "--max-seconds",
                  printed("%.17g", c.max_seconds), "--exact-seconds",
                  printed("%.17g", c.exact_seconds), "--memory",
                  printed("%.17g", c.limits.memory_MB), "--startup-seconds",
                  printed("%.17g", options.program_limits.startup_seconds)},
      .finish = {},
      .results = options.output};
  for (const ComparedSolver& solver : c.solvers) plan.solvers.push_back(solver.name);
  if (!options.reference.empty())
    plan.finish = {"--reference", std::filesystem::absolute(options.reference).string()};
  if (options.with_views) plan.finish.emplace_back("--views");
  if (!options.report) plan.finish.emplace_back("--no-report");
  write_compare_snakemake(plan, options.snakemake);
  std::cout << "cd " << shell_word(std::filesystem::absolute(options.snakemake).string())
            << "\n  snakemake -s Snakefile --profile slurm   on a cluster with Slurm\n"
            << "  snakemake -s Snakefile --cores 4         on this machine" << std::endl;
  return ExitCode::ok;
}

ExitCode compare(CompareRequest& options) {
  if (options.cases.empty() == options.live.scene.empty())
    throw UsageError("compare: expected cases, or --live SCENE");
  require_own_folder(options.output, {"rows", "trajectories", "start", "exact"});
  if (!options.external.empty() && !options.live.scene.empty())
    throw UsageError("compare: --external: not with --live, whose solver works inside the step");
  options.program_limits.memory_MB = options.comparison.limits.memory_MB;
  std::vector<ComparedSolver> programs;
  try {
    programs = external_solvers(options.external, options.program_limits);
  } catch (const std::invalid_argument& error) {
    throw UsageError(std::string("compare: --external: ") + error.what());
  }
  if (!options.snakemake.empty()) return plan_jobs(options);
  for (ComparedSolver& program : programs) options.comparison.solvers.push_back(std::move(program));
  if (options.comparison.solvers.empty())
    throw UsageError("compare: --solvers none: expected a program that solves, --external");
  restart_with_one_algebra_thread();
  options.comparison.folder = options.output;
  options.comparison.command = own_command();
  if (!options.live.scene.empty()) return compare_live(options);
  std::vector<ReferenceTimes> reference;
  if (!options.reference.empty()) reference = read_reference_times(options.reference);
  const std::vector<CompareCase> cases = compare_cases(options.cases);
  InterruptGuard guard;
  const auto told = [&](const CompareRow& row, bool was_there, size_t done, size_t count) {
    if (options.is_json) return tell_row(row, was_there, done, count);
    return options.is_quiet ? !InterruptGuard::requested() : show(row, was_there, done, count);
  };
  const std::vector<CompareRow> rows = run_comparison(cases, options.comparison, told);
  if (options.with_views)
    write_case_views(rows, options.comparison, [] { return !InterruptGuard::requested(); });
  if (InterruptGuard::requested()) return interrupted();
  if (options.comparison.is_part) return verdict_on_cases(rows, cases.size());
  if (options.report) write_compare_page(options.output, rows, reference);
  const ExitCode code = verdict_on_cases(rows, cases.size());
  if (options.is_json)
    tell({{"event", "end"},
          {"folder", options.output.string()},
          {"exit_code", static_cast<int>(code)}});
  if (options.telling() != Telling::reader) return code;
  std::cout << '\n'
            << compare_summary(rows, reference) << "\nresults in " << options.output.string()
            << "\n"
            << (options.report ? "  compare.html  figures and tables: open it in a browser\n" : "")
            << "  results.csv   one row per solve; rows/*.json: the same with their histories\n"
            << "  manifest.json program, machine, BLAS, options" << std::endl;
  return code;
}

}  // namespace

Command compare_command() {
  const auto options = std::make_shared<CompareRequest>();
  CompareOptions& comparison = options->comparison;
  LiveOptions& live = options->live;
  comparison.exact_seconds = 5.0;
  return {
      "compare",
      "Backends on identical problems: accuracy against cost, figures, a page",
      {{"cases", &options->cases, "Problem files, folders, patterns, known:..., stress:..."},
       {"--solvers", &options->solvers,
        "Names, separated by commas, or all, or none: programs alone", shown,
        into(comparison.solvers, solvers_or_none)},
       {"--external NAME=COMMAND", &options->external,
        "Also a program that solves, or FILE.toml with a list (docs/manual/external.md)"},
       {"--startup-seconds", &options->program_limits.startup_seconds,
        "Wall clock that such a program may take beside --max-seconds, to start and read", shown,
        at_least(0)},
       {"--tolerances", &options->tolerances, "Separated by commas", shown,
        into(comparison.tolerances, parse_tolerances)},
       {"--starts", &options->starts, "cold, warm or cold,warm; warm where a case has a warm start",
        shown, into(comparison.starts, parse_starts)},
       {"--measure", &options->measure, "natural_map or fclib", shown,
        into(comparison.measure, measure_of)},
       {"--repeats", &comparison.repeats, "Interleaved; tables show the median", shown,
        at_least(1)},
       {"--max-seconds", &comparison.max_seconds, "Wall clock of one solve, prepare included",
        shown, above(0)},
       {"--exact-seconds", &comparison.exact_seconds,
        "Spent on a solution at 1e-9 of each case, from which distances are measured; 0: none",
        shown, at_least(0)},
       {"--memory", &comparison.limits.memory_MB, "Address space of one child in MB; 0: no limit",
        shown, at_least(0)},
       {"--reference FILE", &options->reference,
        "CSV of others' times: problem,ms_1e-4,solver_1e-4,..."},
       {"--output DIR", &options->output, "Folder of the results", shown},
       {"--no-report", &options->report, "No figures and no page"},
       {"--views", &options->with_views,
        "Of captured cases also a page each in 3D, where in the packing which backend is wrong"},
       {"--quiet", &options->is_quiet, "Says nothing but failures"},
       {"--snakemake DIR", &options->snakemake,
        "Solves nothing, but writes cases x backends as a Snakefile with a profile for Slurm"},
       {"--part", &comparison.is_part,
        "One of several processes that fill one folder: rows alone; being killed is a row"},
       {"--json", &options->is_json,
        "Every solve for programs: one JSON object a line on stdout, nothing else",
        excludes("--quiet")},
       {"--live SCENE", &live.scene,
        "Instead of cases: a scene's closed loop from one start under each backend and tolerance"},
       {"--set KEY=VALUE", &live.overrides, "Of that scene: dotted.key=value"},
       {"--from", &live.start,
        "Simulated time up to which the scene's own solver goes, once for all [s]", at_least(0)},
       {"--duration", &live.duration, "Simulated from there under each backend [s]", shown,
        above(0)},
       {"--trajectory-seconds", &live.trajectory_seconds, "Wall clock of one trajectory", shown,
        above(0)},
       {"--packing-cache DIR", &live.packing_cache,
        "Where deposited packings are kept (<output>/packings)"}},
      [options] { return compare(*options); },
      {compare_diff_command(), compare_merge_command(), compare_collect_command()}};
}

}  // namespace ballast
