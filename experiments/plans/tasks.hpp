#pragma once
// What running a plan has to do: deposits, and the runs that wait for them.

#include <filesystem>
#include <string>
#include <vector>

#include "experiments/plans/resolved_run.hpp"

namespace ballast {

enum class TaskState { waiting, running, finished, failed, stopped };

struct Task {
  std::string title;  ///< for the user: the run's name, or whose packing it is
  std::string key;    ///< of the run or the packing
  std::filesystem::path folder,
      log;  ///< the run's folder, empty for a deposit; what the process prints
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

}  // namespace ballast
