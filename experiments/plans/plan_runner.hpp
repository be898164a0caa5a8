#pragma once
// Many runs in one folder of results: what there is to do, the engine that sees to it that it is
// done, each run as a process of its own, and the same as lines for a shell.
//
//   <results>/runs/<key>/   the runs
//   <results>/packings/     packings, each deposited once
//   <results>/logs/         what the processes printed: <key>.log, packing-<key>.log
//   <results>/index.csv     plan,name,key,state,steps_done,steps,seconds,error_mean,commit: one row
//                           per run of every plan

#include <filesystem>
#include <set>
#include <string>
#include <vector>

#include "experiments/plans/plan.hpp"
#include "platform/error.hpp"
#include "platform/status_line.hpp"

namespace ballast {

// Where things are in a folder of results.
std::filesystem::path run_folder(const std::filesystem::path& results, const PlannedRun& run);
std::filesystem::path packing_folder(const std::filesystem::path& results);

/// "finished", "begun" or "waiting": what the run's folder says. Not finished where its manifest is
/// damaged; the run itself then says what is wrong with it.
std::string state_of(const std::filesystem::path& results, const PlannedRun& run);

/// Steps that are in the log of a run that goes on, or has gone on; 0 when there is none.
long steps_in_log(const std::filesystem::path& run_folder);

/// Writes the plan's rows of index.csv anew; those of other plans stay. state: as state_of(), or
/// failed (a key of `failed`); seconds: of wall clock, over all steps; error_mean: rms natural map,
/// mean over steps, in g h; commit: of the program that began the run. What isn't known yet is
/// empty. Throws Error.
void write_index(const std::filesystem::path& results, const Plan& plan,
                 const std::set<std::string>& failed);

enum class TaskState { waiting, running, finished, failed, stopped };

/// A run, or the deposit that it waits for.
struct Task {
  std::string title;                   ///< for the user: the run's name, or whose packing it is
  std::string key;                     ///< of the run or the packing
  std::filesystem::path folder{};      ///< of the run; empty for a deposit
  std::filesystem::path log;           ///< what the process prints
  std::vector<std::string> arguments;  ///< of the ballast program
  long steps = 0;                      ///< of a run
  double work = 0.0;                   ///< see PlannedRun
  int deposit = -1;                    ///< task that must be finished first; -1: none
  TaskState state = TaskState::waiting;

  bool is_run() const { return !folder.empty(); }
};

/// One task per packing that isn't there, then one per distinct run; both longest first. Runs that
/// are finished are so from the start.
std::vector<Task> make_tasks(const std::filesystem::path& results, std::vector<PlannedRun> runs);

struct PlanOptions {
  std::filesystem::path results = "results";
  int jobs = 1;               ///< processes at a time
  std::string only = {};      ///< names to run, as a shell's pattern; empty: all
  double max_seconds = 1e30;  ///< wall clock: everything is stopped with checkpoints after this
  StatusLine::Style style = StatusLine::style_of_stderr();
};

/// Runs what isn't finished: packings first, the longest first, what was begun continues at its
/// checkpoint. A run that fails is reported and the others go on. Says on stdout what happens and
/// on stderr how far everything is.
///
/// ok: all are finished. failure: some failed, or SIGINT or SIGTERM: all are stopped with
/// checkpoints. time_limit: as that, after max_seconds. The same call goes on. Killed (-9), its
/// children die with it, and the same call goes on at the last checkpoints. Throws Error,
/// also where another plan is run in the folder.
ExitCode run_plan(const Plan& plan, const PlanOptions& options);

/// The tasks that are not finished, as lines for a shell: of `options` the results and the runs to
/// do. Paths are absolute. Each line may be run again, and in any order: a run waits for its
/// packing or deposits it. Makes the empty folders. Throws Error.
std::vector<std::string> plan_commands(const Plan& plan, const PlanOptions& options);

/// How far a plan is, on one line: "37 %  0 of 2 runs, 1 running". Runs that go on count by the
/// steps in their logs, `work_before` is what was done when the plan was taken up, `seconds` ago.
std::string plan_progress(const std::vector<Task>& tasks, double work_before, double seconds);
/// Work that has been done, of all tasks.
double work_done(const std::vector<Task>& tasks);

}  // namespace ballast
