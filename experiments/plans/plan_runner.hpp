#pragma once
// Many runs in one folder of results (docs/manual/plans.md): the tasks, the engine that carries
// them out, each run in a process of its own, and the same tasks as lines for a shell.

#include <filesystem>
#include <set>
#include <string>
#include <vector>

#include "experiments/plans/plan.hpp"
#include "platform/error.hpp"
#include "platform/status_line.hpp"

namespace ballast {

// The places of runs and packings in a folder of results.
std::filesystem::path run_folder(const std::filesystem::path& results, const PlannedRun& run);
std::filesystem::path packing_folder(const std::filesystem::path& results);

/// "finished", "begun" or "waiting", from the run's folder. A run whose manifest is damaged is not
/// finished; the run itself then reports the damage.
std::string state_of(const std::filesystem::path& results, const PlannedRun& run);

/// The number of steps in the log of a run that goes on or has ended; 0 when there is no log.
long steps_in_log(const std::filesystem::path& run_folder);

/// Writes the plan's rows of index.csv anew; those of other plans stay. state: as state_of(), or
/// failed (a key of `failed`); error_mean: rms natural map, mean over steps, in g h. Values that
/// are not known yet are empty. Throws Error.
void write_index(const std::filesystem::path& results, const Plan& plan,
                 const std::set<std::string>& failed);

enum class TaskState { waiting, running, finished, failed, stopped };

/// A run, or a deposit that runs wait for.
struct Task {
  std::string title;                   ///< for the user: the run's name, or whose packing it is
  std::string key;                     ///< of the run or the packing
  std::filesystem::path folder{};      ///< of the run; empty for a deposit
  std::filesystem::path log;           ///< the output of the process
  std::vector<std::string> arguments;  ///< for the ballast program
  long steps = 0;                      ///< of a run
  double work = 0.0;                   ///< see PlannedRun
  int deposit = -1;                    ///< task that must be finished first; -1: none
  TaskState state = TaskState::waiting;

  bool is_run() const { return !folder.empty(); }
};

/// One task per missing packing, then one per distinct run; both longest first. Finished runs are
/// marked so from the start.
std::vector<Task> make_tasks(const std::filesystem::path& results, std::vector<PlannedRun> runs);

struct PlanOptions {
  std::filesystem::path results = "results";
  int jobs = 1;               ///< processes at a time
  std::string only = {};      ///< shell pattern of the names to run; empty: all
  double max_seconds = 1e30;  ///< wall clock: everything is stopped with checkpoints after this
  StatusLine::Style style = StatusLine::style_of_stderr();
};

/// Runs the unfinished tasks: packings first, the longest first. Prints events on stdout and the
/// progress on stderr. Returns ok: all are finished. failure: some failed, or after SIGINT or
/// SIGTERM all were stopped with checkpoints. time_limit: all were stopped so after max_seconds.
/// The same call goes on, also when this process was killed (docs/manual/plans.md). Throws Error,
/// also where another plan is run in the folder.
ExitCode run_plan(const Plan& plan, const PlanOptions& options);

/// The unfinished tasks as lines for a shell; of `options` only `results` and `only` count. Paths
/// are absolute. Each line may be run again, and in any order: a run waits for its packing or
/// deposits it. Makes the empty folders. Throws Error.
std::vector<std::string> plan_commands(const Plan& plan, const PlanOptions& options);

/// The progress of a plan on one line: "37 %  0 of 2 runs, 1 running". Unfinished runs count by the
/// steps in their logs. `work_before`: the work done when the plan was taken up, `seconds` ago.
std::string plan_progress(const std::vector<Task>& tasks, double work_before, double seconds);
/// The work that has been done, over all tasks.
double work_done(const std::vector<Task>& tasks);

}  // namespace ballast
