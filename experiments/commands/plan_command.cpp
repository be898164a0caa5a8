#include <CLI/CLI.hpp>

#include <algorithm>
#include <iomanip>
#include <iostream>
#include <memory>
#include <thread>

#include "experiments/box/packing_cache.hpp"
#include "experiments/commands/command.hpp"
#include "experiments/plans/plan_runner.hpp"
#include "experiments/plans/resolved_run.hpp"
#include "experiments/plans/snakemake.hpp"
#include "experiments/run/run_folder.hpp"
#include "platform/program.hpp"

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
  size_t widest = 4;
  for (const ResolvedRun& run : runs) widest = std::max(widest, run.run.name.size());
  std::cout << std::left << std::setw(static_cast<int>(widest)) << "name"
            << "  key               state     " << std::right << std::setw(9) << "steps"
            << "  packing\n";
  for (const ResolvedRun& run : runs) {
    const RunFolder folder(run_folder(running.results, run));
    const char* state = folder.is_finished(run.key) ? "finished"
                        : folder.has_run()          ? "begun"
                                                    : "waiting";
    const bool is_there = fs::exists(packing_file(packing_folder(running.results), run.packing));
    std::cout << std::left << std::setw(static_cast<int>(widest)) << run.run.name << "  " << run.key
              << "  " << std::setw(8) << state << "  " << std::right << std::setw(9) << run.steps
              << "  "
              << (run.packing.empty() ? "none" : run.packing + (is_there ? "" : " (to deposit)"))
              << '\n';
  }
}

ExitCode run_planned(PlanRequest options) {
  if (!(options.running.max_seconds > 0.0))
    throw UsageError("plan: --max-seconds: expected a number > 0");
  const Plan plan = read_plan(options.plan);
  if (options.running.results.empty()) options.running.results = fs::path("results") / plan.name;
  if (options.dry_run) {
    list_runs(plan, options.running);
    return ExitCode::ok;
  }
  if (!options.snakemake.empty()) {
    write_snakemake({plan.name, select(plan, options.running.only)}, options.running.results,
                    own_program(), options.snakemake);
    std::cout << "cd " << options.snakemake.string()
              << "\n  snakemake -s Snakefile --profile slurm   on a cluster with Slurm\n"
              << "  snakemake -s Snakefile --cores 4         on this machine" << std::endl;
    return ExitCode::ok;
  }
  return run_plan(plan, options.running);
}

}  // namespace

void add_plan_command(CLI::App& program, Action& action) {
  CLI::App* command =
      program.add_subcommand("plan", "Many runs, several at a time, each only once");
  command->alias("sweep");  // its name of before
  auto options = std::make_shared<PlanRequest>();
  options->running.results.clear();
  options->running.jobs = static_cast<int>(std::max(1u, std::thread::hardware_concurrency()));
  command->add_option("plan", options->plan, "A plan's file (docs/manual/plans.md)")->required();
  command
      ->add_option("--jobs", options->running.jobs,
                   "Runs at a time (as many as there are processors)")
      ->type_name("N")
      ->check(CLI::Range(1, 4096));
  command
      ->add_option("--output", options->running.results,
                   "The folder of results (results/<plan>); plans may share one")
      ->type_name("DIR");
  command->add_option("--only", options->running.only, "Only runs whose names match: 'nu-*seed=1'")
      ->type_name("PATTERN");
  CLI::Option* dry_run =
      command->add_flag("--dry-run", options->dry_run,
                        "Lists the runs, their keys and how far they are; runs nothing");
  command
      ->add_option("--snakemake", options->snakemake,
                   "Runs nothing, but writes the plan as a Snakefile with a profile for Slurm into "
                   "this folder")
      ->type_name("DIR")
      ->excludes(dry_run);
  command
      ->add_option(
          "--max-seconds", options->running.max_seconds,
          "Wall clock after which everything writes a checkpoint and the program exits with 3")
      ->type_name("S");
  command->footer(
      "Finished runs are skipped, stopped ones go on at their checkpoints, failed ones are tried "
      "again:\n"
      "the same command continues after Ctrl-C, kill -9 or a power cut.\n\n"
      "Examples:\n  ballast plan frequencies.toml --jobs 2\n"
      "  ballast plan frequencies.toml --dry-run\n"
      "  ballast plan frequencies.toml --only 'nu-drive.frequency=5-*' --output results/shared\n"
      "  ballast plan frequencies.toml --snakemake cluster && cd cluster && snakemake -s "
      "Snakefile --profile slurm");
  command->callback([options, &action] { action = [options] { return run_planned(*options); }; });
}

}  // namespace ballast
