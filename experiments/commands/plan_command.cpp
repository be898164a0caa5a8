// Many runs: a plan, and the paper's campaign with its report.

#include <algorithm>
#include <iostream>
#include <memory>
#include <set>
#include <thread>

#include "experiments/box/packing.hpp"
#include "experiments/commands/command.hpp"
#include "experiments/paper/paper_report.hpp"
#include "experiments/plans/plan_runner.hpp"
#include "experiments/plans/resolved_run.hpp"
#include "experiments/plans/snakemake.hpp"
#include "experiments/run/run_folder.hpp"
#include "platform/atomic_file.hpp"
#include "platform/clock.hpp"
#include "platform/interrupt.hpp"
#include "platform/program.hpp"
#include "platform/text.hpp"

namespace ballast {
namespace {

namespace fs = std::filesystem;

struct PlanRequest {
  fs::path plan;
  PlanOptions running;
  bool dry_run = false;
  fs::path snakemake;
};

/// What would be run.
void list_runs(const Plan& plan, const PlanOptions& running) {
  const std::vector<ResolvedRun> runs = resolve(Plan{plan.name, select(plan, running.only)});
  int widest = 4;
  for (const ResolvedRun& run : runs)
    widest = std::max(widest, static_cast<int>(run.run.name.size()));
  std::cout << printed("%-*s  %-16s  %-8s  %9s  packing\n", widest, "name", "key", "state",
                       "steps");
  for (const ResolvedRun& run : runs) {
    const RunFolder folder(run_folder(running.results, run));
    const char* state = folder.is_finished(run.key) ? "finished"
                        : folder.has_run()          ? "begun"
                                                    : "waiting";
    const bool is_stored = is_there(packing_file(packing_folder(running.results), run.packing));
    const std::string packing =
        run.packing.empty() ? "none" : run.packing + (is_stored ? "" : " (to deposit)");
    std::cout << printed("%-*s  %s  %-8s  %9ld  %s\n", widest, run.run.name.c_str(),
                         run.key.c_str(), state, run.steps, packing.c_str());
  }
}

ExitCode run_planned(PlanRequest options) {
  const Plan plan = read_plan(options.plan);
  if (options.running.results.empty()) options.running.results = fs::path("results") / plan.name;
  if (options.dry_run) {
    list_runs(plan, options.running);
    return ExitCode::ok;
  }
  if (!options.snakemake.empty()) {
    write_snakemake({plan.name, select(plan, options.running.only)}, options.running.results,
                    own_program(), options.snakemake);
    std::cout << "cd " << shell_word(fs::absolute(options.snakemake).string())
              << "\n  snakemake -s Snakefile --profile slurm   on a cluster with Slurm\n"
              << "  snakemake -s Snakefile --cores 4         on this machine" << std::endl;
    return ExitCode::ok;
  }
  require_own_folder(options.running.results, {"runs", "packings"});
  return run_plan(plan, options.running);
}

}  // namespace

Command plan_command() {
  const auto options = std::make_shared<PlanRequest>();
  PlanOptions& running = options->running;
  running.results.clear();
  running.jobs = static_cast<int>(std::max(1u, std::thread::hardware_concurrency()));
  return {"plan",
          "Many runs, several at a time, each only once",
          {{"plan", &options->plan, "A plan's file (docs/manual/plans.md)", required},
           {"--jobs N", &running.jobs, "Runs at a time (as many as there are processors)",
            between(1, 4096)},
           {"--output DIR", &running.results,
            "The folder of results (results/<plan>); plans may share one"},
           {"--only PATTERN", &running.only, "Only runs whose names match: 'nu-*seed=1'"},
           {"--dry-run", &options->dry_run,
            "Lists the runs, their keys and how far they are; runs nothing"},
           {"--snakemake DIR", &options->snakemake,
            "Runs nothing, but writes the plan as a Snakefile with a profile for Slurm into this "
            "folder",
            excludes("--dry-run")},
           {"--max-seconds S", &running.max_seconds,
            "Wall clock after which everything writes a checkpoint and the program exits with 3",
            above(0)}},
          [options] { return run_planned(*options); }};
}

namespace {

struct PaperOptions {
  std::string target;
  CampaignSettings campaign;
  PlanOptions running;
  fs::path output, rows;
};

PaperData data_of(const std::vector<CampaignRun>& campaign, const PaperOptions& options) {
  std::vector<RunRow> rows;
  if (!options.rows.empty()) rows = read_runs_csv(options.rows);
  return {campaign, options.running.results, std::move(rows)};
}

void print_plan(const PaperData& data) {
  std::cout << printed("%-12s%-72s%8s  state\n", "stage", "run", "steps");
  long left = 0;
  std::set<std::string> seen;  // equal runs of several stages are made once
  for (const CampaignRun& run : data.campaign()) {
    const char* state = data.has(run) ? "finished" : data.knows(run) ? "row" : "–";
    if (seen.insert(run.key).second && !data.knows(run)) left += run.steps;
    std::cout << printed("%-12s%-72s%8ld  %s\n", run.stage.c_str(), run.planned.name.c_str(),
                         run.steps, state);
  }
  std::cout << printed("\n%zu runs; %zu finished, %zu known by rows, %ld steps left",
                       data.planned(), data.finished(), data.known_by_row(), left)
            << std::endl;
}

/// Stage by stage, so that time running out leaves whole figures. Not made: runs whose rows are
/// known.
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
  const std::vector<CampaignRun> campaign = read_campaign(options.campaign);
  const std::vector<std::string> targets = paper_targets(campaign);
  const bool is_target = std::find(targets.begin(), targets.end(), options.target) != targets.end();
  if (!is_target && options.target != "plan" && options.target != "report")
    throw UsageError("paper: '" + options.target + "' is none of plan, report, " + joined(targets));
  if (options.output.empty()) options.output = options.running.results / "report";
  const PaperData known = data_of(campaign, options);
  if (known.foreign() > 0)
    std::cerr << "ballast: " << options.rows.string() << ": " << known.foreign()
              << " rows are of no run of this campaign and drawn as they are" << std::endl;
  if (options.target == "plan") {
    print_plan(known);
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
  std::cout << data.finished() << " of " << data.planned() << " runs; report in "
            << (options.output / "paper.html").string() << std::endl;
  return code;
}

}  // namespace

Command paper_command() {
  const auto options = std::make_shared<PaperOptions>();
  PlanOptions& running = options->running;
  CampaignSettings& campaign = options->campaign;
  running.results = "results/paper";
  running.jobs = static_cast<int>(std::max(1u, std::thread::hardware_concurrency()));
  return {"paper",
          "Reproduces the paper: runs, figures 3 to 13, one report",
          {{"target", &options->target,
            "What: all; a section (fig3 to fig13, curve, box ...) or a stage of the campaign; plan "
            "(lists the runs); report (draws what is there, runs nothing)",
            required},
           {"--jobs N", &running.jobs, "Runs at a time (as many as there are processors)",
            between(1, 4096)},
           {"--results DIR", &running.results, "The folder of runs (results/paper)"},
           {"--output DIR", &options->output, "The folder of the report (<results>/report)"},
           {"--rows FILE", &options->rows,
            "A report's data/runs.csv: its runs are taken from there, not made again"},
           {"--max-seconds S", &running.max_seconds,
            "Wall clock after which runs write checkpoints; the report is written all the same",
            above(0)},
           {"--plan FILE", &campaign.plan, "Another campaign (the built-in campaign.toml)"},
           {"--scene SCENE", &campaign.scene, "Another box instead of vibrated_box"},
           {"--set KEY=VALUE", &campaign.overrides, "Overrides one value in every run"},
           {"--only PATTERN", &campaign.only,
            "Runs whose names a shell's pattern takes: '*seed=1*' is one sample"}},
          [options] { return reproduce(*options); }};
}

}  // namespace ballast
