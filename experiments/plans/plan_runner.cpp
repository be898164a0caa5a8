#include "experiments/plans/plan_runner.hpp"

#include <fnmatch.h>
#include <unistd.h>

#include <algorithm>
#include <iostream>
#include <map>
#include <memory>

#include "experiments/plans/plan_progress.hpp"
#include "experiments/plans/results_index.hpp"
#include "experiments/plans/tasks.hpp"
#include "platform/atomic_file.hpp"
#include "platform/clock.hpp"
#include "platform/error.hpp"
#include "platform/interrupt.hpp"
#include "platform/program.hpp"
#include "platform/text.hpp"
#include "problems/scene/scene_file.hpp"

namespace ballast {
namespace fs = std::filesystem;
namespace {

/// Starts tasks in their order while processes are free, and looks at them two hundred times a
/// second.
class Engine {
 public:
  Engine(const PlanOptions& options, std::vector<Task> tasks)
      : options_(options),
        program_(options.program.empty() ? own_program() : options.program),
        tasks_(std::move(tasks)),
        progress_(options.style, tasks_) {}

  /// What stopped everything before its end; ok: nothing did.
  ExitCode execute() {
    ExitCode stopped = ExitCode::ok;
    // Every five milliseconds: take in what has ended, start what can
    // be started, say how far it is.
    while (start_what_can(stopped == ExitCode::ok) || !workers_.empty()) {
      collect();
      if (stopped == ExitCode::ok &&
          (InterruptGuard::requested() || seconds() > options_.max_seconds)) {
        stopped = InterruptGuard::requested() ? ExitCode::failure : ExitCode::time_limit;
        // they write a checkpoint and end; the loop goes on until all have
        for (const auto& [task, worker] : workers_) worker->stop();
      }
      progress_.show(seconds());
      if (seconds() > indexed_ + 20.0) index();
      usleep(5000);
    }
    progress_.end();
    index();
    return stopped;
  }

  const std::vector<Task>& tasks() const { return tasks_; }

 private:
  double seconds() const { return watch_.seconds(); }

  /// False when nothing was there to start; failed deposits take their runs with them.
  bool start_what_can(bool may_start) {
    bool started = false;
    for (size_t k = 0; k < tasks_.size(); ++k) {
      Task& task = tasks_[k];
      if (task.state != TaskState::waiting) continue;
      const Task* deposit = task.deposit < 0 ? nullptr : &tasks_[static_cast<size_t>(task.deposit)];
      if (deposit && deposit->state == TaskState::failed) {
        fail(task, deposit->title + " failed");
        continue;
      }
      const bool ready = !deposit || deposit->state == TaskState::finished;
      if (!may_start || !ready || workers_.size() >= static_cast<size_t>(options_.jobs)) continue;
      // runs wait for their packing, and everything for a free process
      workers_.emplace(k, std::make_unique<BackgroundProgram>(program_, task.arguments, task.log));
      task.state = TaskState::running;
      begun_[k] = seconds();
      started = true;
    }
    return started;
  }

  void collect() {
    for (auto at = workers_.begin(); at != workers_.end();) {
      if (!at->second->has_ended()) {
        ++at;
        continue;
      }
      ended(at->first, at->second->status());
      at = workers_.erase(at);
    }
  }

  void ended(size_t k, int status) {
    Task& task = tasks_[k];
    if (status == static_cast<int>(ExitCode::ok)) {
      task.state = TaskState::finished;
      progress_.say("finished  " + task.title + "  " + duration_text(seconds() - begun_[k]));
    } else if (InterruptGuard::requested() || seconds() > options_.max_seconds) {
      task.state = TaskState::stopped;
    } else if (status > 128) {
      fail(task, "ended by signal " + std::to_string(status - 128));
    } else {
      fail(task, last_line(task.log));
    }
  }

  void fail(Task& task, const std::string& reason) {
    task.state = TaskState::failed;
    task.reason = reason;
    progress_.say("FAILED    " + task.title + ": " + reason + " (" + task.log.string() + ")");
  }

  /// index.csv, every twenty seconds and at the end: what has failed is known here alone.
  void index() {
    std::map<std::string, std::string> failed;
    for (const Task& task : tasks_)
      if (task.state == TaskState::failed) failed.emplace(task.key, task.reason);
    write_index(options_.results, failed);
    indexed_ = seconds();
  }

  const PlanOptions& options_;
  fs::path program_;
  std::vector<Task> tasks_;
  PlanProgress progress_;
  Stopwatch watch_;
  double indexed_ = 0.0;
  std::map<size_t, std::unique_ptr<BackgroundProgram>> workers_;  // by task
  std::map<size_t, double> begun_;
};

/// What came out, and how to go on.
ExitCode conclude(const std::vector<Task>& tasks, size_t before, ExitCode stopped,
                  const fs::path& results) {
  size_t runs = 0, finished = 0, failed = 0;
  for (const Task& task : tasks) {
    if (!task.is_run()) continue;
    ++runs;
    finished += task.state == TaskState::finished;
    failed += task.state == TaskState::failed;
  }
  std::cout << runs << " runs: " << finished << " finished (" << before << " of them before)";
  if (failed > 0) std::cout << ", " << failed << " failed";
  if (runs > finished + failed) std::cout << ", " << runs - finished - failed << " to do";
  std::cout << "; see " << (results / "index.csv").string() << std::endl;
  if (stopped != ExitCode::ok) {
    std::cout << (stopped == ExitCode::time_limit ? "time limit reached" : "interrupted")
              << "; nothing is lost: the same command goes on" << std::endl;
    return stopped;
  }
  return failed > 0 ? ExitCode::failure : ExitCode::ok;
}

}  // namespace

std::vector<PlannedRun> select(const Plan& plan, const std::string& pattern) {
  std::vector<PlannedRun> runs;
  for (const PlannedRun& run : plan.runs)
    if (pattern.empty() || fnmatch(pattern.c_str(), run.name.c_str(), 0) == 0) runs.push_back(run);
  if (runs.empty()) throw SceneFileError("plan " + plan.name + ": no run is named like " + pattern);
  return runs;
}

ExitCode run_plan(const Plan& plan, const PlanOptions& options) {
  validate(plan, "plan " + plan.name);
  // everything that can be wrong with the plan is found before anything is written
  const std::vector<ResolvedRun> all = resolve(plan);
  const std::vector<ResolvedRun> chosen = resolve(Plan{plan.name, select(plan, options.only)});
  const InterruptGuard guard;
  for (const char* name : {"runs", "packings", "logs"}) create_folder(options.results / name);
  const FileLock lock(options.results / "plan.lock", briefly);
  if (!lock.is_held())
    throw Error(options.results.string() + ": " + lock.holder() + " is running a plan there");
  note_plan(options.results, plan.name, all);
  Engine engine(options, make_tasks(options.results, chosen));
  const auto finished = [](const Task& task) {
    return task.is_run() && task.state == TaskState::finished;
  };
  const size_t before =
      static_cast<size_t>(std::count_if(engine.tasks().begin(), engine.tasks().end(), finished));
  const ExitCode stopped = engine.execute();
  return conclude(engine.tasks(), before, stopped, options.results);
}

}  // namespace ballast
