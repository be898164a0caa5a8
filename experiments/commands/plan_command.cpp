#include <algorithm>
#include <iostream>
#include <memory>
#include <thread>

#include "experiments/box/packing_cache.hpp"
#include "experiments/commands/command.hpp"
#include "experiments/plans/plan_runner.hpp"
#include "experiments/plans/resolved_run.hpp"
#include "experiments/plans/snakemake.hpp"
#include "experiments/run/run_folder.hpp"
#include "platform/atomic_file.hpp"
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

}  // namespace ballast
