#include "experiments/plans/tasks.hpp"

#include <algorithm>
#include <map>
#include <set>

#include "experiments/box/packing_cache.hpp"
#include "experiments/run/run_folder.hpp"
#include "platform/atomic_file.hpp"
#include "platform/error.hpp"

namespace ballast {
namespace fs = std::filesystem;
namespace {

/// A manifest that is damaged does not count; the run itself then says what is wrong with it.
bool is_finished(const fs::path& folder, const std::string& key) {
  try {
    return RunFolder(folder).is_finished(key);
  } catch (const Error&) {
    return false;
  }
}

Task run_task(const fs::path& results, const ResolvedRun& run) {
  Task task;
  task.title = run.run.name;
  task.key = run.key;
  task.folder = run_folder(results, run);
  task.log = results / "logs" / (run.key + ".log");
  task.arguments = run_arguments(results, run);
  task.steps = run.steps;
  task.work = run.work;
  if (is_finished(task.folder, run.key)) task.state = TaskState::finished;
  return task;
}

Task deposit_task(const fs::path& results, const ResolvedRun& run) {
  Task task;
  task.title = "packing of " + run.run.name;
  task.key = run.packing;
  task.log = results / "logs" / ("packing-" + run.packing + ".log");
  task.arguments = deposit_arguments(results, run);
  task.work = run.packing_work;
  return task;
}

void sort_by_work(std::vector<Task>& tasks) {
  std::stable_sort(tasks.begin(), tasks.end(),
                   [](const Task& a, const Task& b) { return a.work > b.work; });
}

}  // namespace

std::vector<Task> make_tasks(const fs::path& results, const std::vector<ResolvedRun>& runs) {
  // A packing that several runs need is deposited once. Of deposits and of drives the longest come
  // first, so that no long one is left for the end.
  std::vector<Task> drives, tasks;
  std::map<std::string, Task> deposits;           // by packing
  std::map<std::string, std::string> packing_of;  // run -> packing
  std::set<std::string> seen;                     // two names may be one run
  for (const ResolvedRun& run : runs) {
    if (!seen.insert(run.key).second) continue;
    drives.push_back(run_task(results, run));
    const bool needs_packing = drives.back().state != TaskState::finished && !run.packing.empty() &&
                               !is_there(packing_file(packing_folder(results), run.packing));
    if (!needs_packing) continue;
    packing_of[run.key] = run.packing;
    deposits.emplace(run.packing, deposit_task(results, run));
  }
  // the deposits in their final order first: runs refer to them by their place
  for (auto& [key, task] : deposits) tasks.push_back(std::move(task));
  sort_by_work(tasks);
  std::map<std::string, int> place;  // of a deposit
  for (size_t k = 0; k < tasks.size(); ++k) place[tasks[k].key] = static_cast<int>(k);
  sort_by_work(drives);
  for (Task& task : drives) {
    if (const auto found = packing_of.find(task.key); found != packing_of.end())
      task.deposit = place.at(found->second);
    tasks.push_back(std::move(task));
  }
  return tasks;
}

}  // namespace ballast
