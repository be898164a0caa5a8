#pragma once
// What running a plan has to do: deposits, and the runs that wait for them.

#include <filesystem>
#include <string>
#include <vector>

#include "experiments/plans/resolved_run.hpp"
#include "platform/error.hpp"
#include "platform/status_line.hpp"

namespace ballast {

enum class TaskState { waiting, running, finished, failed, stopped };

struct Task {
  std::string title;                   ///< for the user: the run's name, or whose packing it is
  std::string key;                     ///< of the run or the packing
  std::filesystem::path folder;        ///< of the run; empty for a deposit
  std::filesystem::path log;           ///< what the process prints
  std::vector<std::string> arguments;  ///< of the ballast program
  long steps = 0;                      ///< of a run
  double work = 0.0;                   ///< see ResolvedRun
  int deposit = -1;                    ///< task that must be finished first; -1: none
  TaskState state = TaskState::waiting;
  std::string reason;  ///< why it failed

  bool is_run() const { return !folder.empty(); }
};

/// One task per packing that isn't there, then one per distinct run; both longest first. Runs that
/// are finished are so from the start.
std::vector<Task> make_tasks(const std::filesystem::path& results,
                             const std::vector<ResolvedRun>& runs);

// The engine: sees to it that the runs of a plan are there, each as a process of its own.

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
///   <results>/plans/, index.csv   see resolved_run.hpp
///
/// ok: all are finished. failure: some failed, or SIGINT or SIGTERM: all are stopped with
/// checkpoints. time_limit: as that, after max_seconds. The same call goes on. Killed (-9), its
/// children die with it, and the same call goes on at the last checkpoints. Throws SceneFileError,
/// and Error when another plan is run in the folder or it cannot be written.
ExitCode run_plan(const Plan& plan, const PlanOptions& options);

/// How far a plan is, on one line.
class PlanProgress {
 public:
  /// `tasks` outlive this and change while it looks.
  PlanProgress(StatusLine::Style style, const std::vector<Task>& tasks);

  /// `now`: seconds since the plan was taken up. Costs next to nothing unless it is time to write.
  void show(double now);
  /// Something happened: a line on stdout.
  void say(const std::string& text);
  void end() { line_.end(); }

 private:
  /// Work that has been done, of all tasks: runs that go on by the steps in their logs.
  double work_done() const;
  std::string text(double now) const;

  StatusLine line_;
  const std::vector<Task>& tasks_;
  double all_work_ = 0.0, work_before_ = 0.0;
  double written_ = 0.0;
};

}  // namespace ballast
