// The commands run, report (draws a run's page again: after a full disk, with gnuplot installed
// meanwhile, or during the run), plan (many runs) and paper (the campaign and its report).

#include <algorithm>
#include <iostream>
#include <memory>
#include <set>

#include "experiments/box/packing.hpp"
#include "experiments/commands/command.hpp"
#include "experiments/measure/run_data.hpp"
#include "experiments/paper/sections.hpp"
#include "experiments/plans/plan_runner.hpp"
#include "experiments/run/run.hpp"
#include "experiments/run/run_folder.hpp"
#include "experiments/run_page/report.hpp"
#include "platform/atomic_file.hpp"
#include "platform/clock.hpp"
#include "platform/error.hpp"
#include "platform/interrupt.hpp"
#include "platform/program.hpp"
#include "platform/text.hpp"
#include "platform/worker_team.hpp"

namespace ballast {
namespace {

namespace fs = std::filesystem;

struct RunRequest {
  RunOptions run;
  bool with_page = true, strict = false;
  bool is_quiet = false;
};

/// This command line, changed so that it continues the run that it has begun, from the folder where
/// it was given and with all its options.
std::string command_that_goes_on() {
  std::vector<std::string> words = process_arguments();
  words[0] = executable_path().string();
  // The option that would begin the run anew is left out.
  std::erase(words, "--overwrite");
  const auto is_given = [&](const char* word) {
    return std::find(words.begin(), words.end(), word) != words.end();
  };
  if (!is_given("--continue") && !is_given("--deposit-only")) words.push_back("--continue");
  return "cd " + shell_quoted(fs::current_path().string()) + " && " + shell_line(words);
}

/// Draws the run's page where it is asked for, unless a finished run has it; prints where the
/// results are and what can be done next.
void show_results(const RunEnd& end, const RunRequest& request, bool has_grains) {
  const bool with_page = request.with_page, has_page = path_exists(end.folder / "report.html");
  if (with_page && (!end.was_finished || !has_page)) write_report(end.folder);
  if (end.was_finished || request.run.style == Progress::Style::quiet) return;
  std::cout << "\nresults in " << end.folder.string() << "\n";
  if (with_page)
    std::cout << "  report.html   figures and the table of the run: open it in a browser\n";
  std::cout << "  steps.csv     every step's scalars\n"
            << "  record.h5     the same and the poses (HDF5)\n";
  if (path_exists(end.folder / "capture"))
    std::cout << "  capture/      friction problems of steps, for ballast compare\n";
  else if (request.run.capture.to > 0)
    std::cout << "  no capture/   the run has no step that --capture names\n";
  std::cout << "  manifest.json machine, commit, parameters, summary\n\nwhat next\n"
            << next_commands(has_grains) << std::flush;
}

/// Prints what the user must know of a finished run. With --strict only a clean run is a success.
ExitCode tell_trust(const RunData& data, const RunRequest& request) {
  const RunSummary run = summarise(data.steps, data.facts);
  const bool is_failure = request.strict && !has_no_findings(run);
  if (is_failure || request.run.style != Progress::Style::quiet) {
    std::cout << "\nto be known\n";
    for (const std::string& words : run_findings(run)) std::cout << "  " << words << '\n';
    std::cout << std::flush;
  }
  if (!is_failure) return ExitCode::ok;
  std::cerr << "ballast: " << request.run.scene << ": --strict: finished, with what is said above"
            << std::endl;
  return ExitCode::failure;
}

ExitCode run_scene(RunRequest& request) {
  restart_with_one_algebra_thread();
  request.run.again = command_that_goes_on();
  if (request.is_quiet) request.run.style = StatusLine::Style::quiet;
  // more threads than cores only wait for each other
  request.run.threads = std::min(request.run.threads, available_cores());
  const RunEnd end = run(request.run);
  if (end.code != ExitCode::ok) {
    std::cerr << "ballast: " << request.run.scene
              << ": stopped before its end; --continue goes on with it" << std::endl;
    return end.code;
  }
  if (request.run.deposit_only) return ExitCode::ok;
  const RunData data = read_run_data(end.folder);
  show_results(end, request, data.facts.has_packing);
  return tell_trust(data, request);
}

struct PlanRequest {
  fs::path plan;
  PlanOptions running;
  bool dry_run = false, commands = false;
};

/// Prints the runs that would be made.
void list_runs(const Plan& plan, const PlanOptions& running) {
  const std::vector<PlannedRun> runs = select(plan, running.only);
  int widest = 4;
  for (const PlannedRun& run : runs) widest = std::max(widest, static_cast<int>(run.name.size()));
  std::cout << printed("%-*s  %-16s  %-8s  %9s  packing\n", widest, "name", "key", "state",
                       "steps");
  for (const PlannedRun& run : runs) {
    const bool is_stored = path_exists(packing_file(packing_folder(running.results), run.packing));
    const std::string packing =
        run.packing.empty() ? "none" : run.packing + (is_stored ? "" : " (to deposit)");
    std::cout << printed("%-*s  %s  %-8s  %9ld  %s\n", widest, run.name.c_str(), run.key.c_str(),
                         state_of(running.results, run).c_str(), run.steps, packing.c_str());
  }
}

ExitCode run_planned(PlanRequest options) {
  const Plan plan = read_plan(options.plan);
  if (options.running.results.empty()) options.running.results = fs::path("results") / plan.name;
  if (options.dry_run) {
    list_runs(plan, options.running);
    return ExitCode::ok;
  }
  require_own_folder(options.running.results, {"runs", "packings"});
  if (!options.commands) return run_plan(plan, options.running);
  for (const std::string& line : plan_commands(plan, options.running)) std::cout << line << '\n';
  return ExitCode::ok;
}

struct PaperOptions {
  std::string target;
  CampaignSettings campaign;
  PlanOptions running;
  fs::path output, rows;
};

PaperData data_of(const std::vector<PlannedRun>& campaign, const PaperOptions& options) {
  std::vector<RunRow> rows;
  if (!options.rows.empty()) rows = read_runs_csv(options.rows);
  return {campaign, options.running.results, std::move(rows)};
}

void print_plan(const PaperData& data) {
  std::cout << printed("%-12s%-72s%8s  state\n", "stage", "run", "steps");
  long left = 0;
  std::set<std::string> seen;  // equal runs of several stages are made once
  for (const PlannedRun& run : data.campaign()) {
    const char* state = data.has(run) ? "finished" : data.knows(run) ? "row" : "–";
    if (seen.insert(run.key).second && !data.knows(run)) left += run.steps;
    std::cout << printed("%-12s%-72s%8ld  %s\n", stage_of(run).c_str(), run.name.c_str(), run.steps,
                         state);
  }
  std::cout << printed("\n%zu runs; %zu finished, %zu known by rows, %ld steps left",
                       data.planned(), data.finished(), data.known_by_row(), left)
            << std::endl;
}

/// Makes the runs stage by stage, so that whole figures exist when the time runs out. Runs whose
/// rows are known are not made.
ExitCode run_stages(const PaperData& data, const PaperOptions& options) {
  const Stopwatch watch;
  ExitCode worst = ExitCode::ok;
  for (const Plan& stage : stages_of(data, options.target)) {
    PlanOptions running = options.running;
    running.max_seconds -= watch.seconds();
    if (!(running.max_seconds > 0.0)) return ExitCode::time_limit;
    std::cout << "stage " << stage.name << ": " << stage.runs.size() << " runs" << std::endl;
    const ExitCode code = run_plan(stage, running);
    if (code == ExitCode::time_limit) return code;
    if (code != ExitCode::ok) worst = code;
    if (code != ExitCode::ok && InterruptGuard::requested()) return code;
  }
  return worst;
}

ExitCode reproduce(PaperOptions options) {
  const std::vector<PlannedRun> campaign = read_campaign(options.campaign);
  std::vector<std::string> targets{"plan", "report", "article", "archive"};
  const std::vector<std::string> run_targets = paper_targets(campaign);
  targets.insert(targets.end(), run_targets.begin(), run_targets.end());
  if (std::ranges::find(targets, options.target) == targets.end())
    throw UsageError("paper: '" + options.target + "' is none of " + joined(targets));
  if (options.target == "archive" &&
      !(options.campaign.scene.empty() && options.campaign.overrides.empty()))
    throw UsageError("paper archive: not with --scene or --set: its plan would not make its rows");
  if (options.output.empty())
    options.output = options.running.results / (options.target == "archive" ? "archive" : "report");
  PaperData known = data_of(campaign, options);
  if (known.foreign() > 0)
    std::cerr << "ballast: " << options.rows.string() << ": " << known.foreign()
              << " rows are of no run of this campaign and drawn as they are" << std::endl;
  if (options.target == "plan") {
    print_plan(known);
    return ExitCode::ok;
  }
  const bool makes_runs = std::ranges::find(run_targets, options.target) != run_targets.end();
  if (!makes_runs && known.finished() + known.known_by_row() + known.foreign() == 0)
    throw Error(options.running.results.string() +
                ": holds no finished run of the campaign; --rows FILE takes runs from a table");
  if (options.target != "archive")
    require_own_folder(options.output, {{"data/runs_columns.csv", "column,unit,"},
                                        {"article.md", "computed from the rows of its campaign"}});
  if (options.target == "article") {
    const ExitCode code = write_article(known, options.output, std::cerr);
    std::cout << "article in " << (options.output / "article.md").string() << std::endl;
    return code;
  }
  if (options.target == "archive") {
    const ArchiveOptions order{options.campaign.plan, options.running.results / "packings",
                               options.output};
    std::cout << write_archive(known, order).string() << std::endl;
    return ExitCode::ok;
  }
  require_own_folder(options.running.results, {"runs", "packings", "report"});
  // "report" draws what is there; every other target makes its runs first
  ExitCode code = ExitCode::ok;
  if (options.target == "report")
    options.target = "all";
  else
    code = run_stages(known, options);
  PaperData data = data_of(campaign, options);
  write_paper_report(data, make_sections(data, options.target), options.output);
  std::cout << data.finished() << " of " << data.planned() << " runs, "
            << data.known_by_row() + data.foreign() << " known by rows; report in "
            << (options.output / "paper.html").string() << std::endl;
  return code;
}

}  // namespace

Command report_command() {
  const auto folders = std::make_shared<std::vector<std::string>>();
  return {"report",
          "Draws the page of a run, report.html, from its record again, also while the run goes on",
          {{"run", folders.get(), "Folders of runs", required}},
          [folders] {
            for (const fs::path folder : *folders) {
              if (!RunFolder(folder).has_run())
                throw Error(folder.string() + ": no run here: scene.toml is missing");
              write_report(folder);
              std::cout << (folder / "report.html").string() << std::endl;
            }
            return ExitCode::ok;
          }};
}

Command run_command() {
  const auto request = std::make_shared<RunRequest>();
  RunOptions& run = request->run;
  return {
      "run",
      "Simulates a scene and writes a folder of results",
      {{"scene", &run.scene, "A scene's name (ballast scenes) or a TOML file", required},
       {"--set KEY=VALUE", &run.overrides,
        "Overrides one value of the scene: dotted.key=value, for example body.0.mass=2"},
       {"--output DIR", &run.output, "The run's folder (default: results/<scene>)"},
       {"--overwrite", &run.overwrite, "Replaces the run found in the folder"},
       {"--continue", &run.resume,
        "Continues the run found in the folder or begins one; does nothing when it is finished",
        excludes("--overwrite")},
       {"--deposit-only", &run.deposit_only, "Only deposits the packing, unless the cache has it"},
       {"--packing-cache DIR", &run.packing_cache,
        "Where deposited packings are kept (default: <output>/../packings)"},
       {"--capture WHICH", into(run.capture, CaptureSettings::parse),
        "Writes friction problems as FCLIB files into <output>/capture: every=50 (steps 50, 51, "
        "100, 101, ...; steps=3: three each time), from=1000,to=1020, also=10 (step 10 too)"},
       {"--threads N", &run.threads,
        "Threads of a step, at most the cores; the results are the same to the last bit",
        between(1, 256)},
       {"--max-seconds S", &run.max_seconds,
        "Wall clock [s] after which a checkpoint is written and the exit code is 3", above(0)},
       {"--strict", &request->strict,
        "Exit code 1 if steps missed their tolerance, overlaps are visible or energy was gained"},
       {"--quiet", &request->is_quiet, "Prints nothing but failures"},
       {"--no-report", &request->with_page, "Draws no figures and no page at the end"}},
      [request] { return run_scene(*request); }};
}

Command plan_command() {
  const auto options = std::make_shared<PlanRequest>();
  PlanOptions& running = options->running;
  running.results.clear();
  running.jobs = available_cores();
  return {"plan",
          "Makes the runs of a plan, several at a time, each only once",
          {{"plan", &options->plan, "The plan, a TOML file (docs/manual/plans.md)", required},
           {"--jobs N", &running.jobs, "Number of runs at a time", between(1, 4096)},
           {"--output DIR", &running.results,
            "Folder of results (default: results/<plan>); plans may share it"},
           {"--only PATTERN", &running.only, "Takes only runs whose names match: 'nu-*seed=1'"},
           {"--dry-run", &options->dry_run,
            "Lists the runs with their keys, states and packings; runs nothing"},
           {"--commands", &options->commands,
            "Prints missing packings, then unfinished runs, as shell commands; runs nothing",
            excludes("--dry-run")},
           {"--max-seconds S", &running.max_seconds,
            "Wall clock [s] after which all runs stop with checkpoints and the exit code is 3",
            above(0)}},
          [options] { return run_planned(*options); }};
}

Command paper_command() {
  const auto options = std::make_shared<PaperOptions>();
  PlanOptions& running = options->running;
  CampaignSettings& campaign = options->campaign;
  running.results = "results/paper";
  running.jobs = available_cores();
  return {"paper",
          "Reproduces the paper (Azema et al.): its runs, figures 3 to 13, a report",
          {{"target", &options->target,
            "all, a section (fig3 to fig13, curve, box, ...) or a campaign stage: its runs and a "
            "report; plan: lists the runs; report, article, archive: from existing runs alone",
            required},
           {"--jobs N", &running.jobs, "Number of runs at a time", between(1, 4096)},
           {"--results DIR", &running.results, "Folder of the runs"},
           {"--output DIR", &options->output,
            "Folder of the report (default: <results>/report) or archive (<results>/archive)"},
           {"--rows FILE", &options->rows,
            "data/runs.csv of a report: the runs in it are taken from there, not made again"},
           {"--max-seconds S", &running.max_seconds,
            "Wall clock [s] after which runs stop with checkpoints; the report is still written",
            above(0)},
           {"--plan FILE", &campaign.plan, "Campaign plan instead of the built-in campaign.toml"},
           {"--scene SCENE", &campaign.scene, "Scene of a box instead of vibrated_box"},
           {"--set KEY=VALUE", &campaign.overrides, "Overrides one value in every run"},
           {"--only PATTERN", &campaign.only,
            "Takes only runs whose names match: '*seed=1*' is one sample"}},
          [options] { return reproduce(*options); }};
}

}  // namespace ballast
