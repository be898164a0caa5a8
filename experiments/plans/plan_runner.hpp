#pragma once
// The engine: sees to it that the runs of a plan are there, each as a process of its own.

#include <filesystem>
#include <string>
#include <vector>

#include "experiments/plans/plan.hpp"
#include "platform/error.hpp"
#include "platform/status_line.hpp"

namespace ballast {

struct PlanOptions {
  std::filesystem::path results = "results";
  int jobs = 1;                   ///< processes at a time
  std::string only;               ///< names to run, as a shell's pattern; empty: all
  double max_seconds = 1e30;      ///< wall clock: everything is stopped with checkpoints after this
  std::filesystem::path program;  ///< ballast; empty: this program itself
  StatusLine::Style style = StatusLine::style_of_stderr();
};

/// Runs what isn't finished: packings first, the longest first, what was begun continues at its
/// checkpoint. A run that fails is reported and the others go on. Says on stdout what happens and
/// on stderr how far everything is.
///
///   <results>/runs/<key>/      the runs
///   <results>/packings/        packings, each deposited once
///   <results>/logs/            what the processes printed: <key>.log, packing-<key>.log
///   <results>/plans/, index.csv   see results_index.hpp
///
/// ok: all are finished. failure: some failed, or SIGINT or SIGTERM: all are stopped with
/// checkpoints. time_limit: as that, after max_seconds. The same call goes on. Killed (-9), its
/// children die with it, and the same call goes on at the last checkpoints. Throws SceneFileError,
/// and Error when another plan is run in the folder or it cannot be written.
ExitCode run_plan(const Plan& plan, const PlanOptions& options);

/// The runs of the plan that a shell's pattern names. Throws SceneFileError when there are none.
std::vector<PlannedRun> select(const Plan& plan, const std::string& pattern);

}  // namespace ballast
