#include "experiments/plans/plan_runner.hpp"

#include <algorithm>
#include <cmath>
#include <iostream>
#include <map>
#include <memory>
#include <set>

#include <signal.h>
#include <unistd.h>

#include "experiments/box/packing.hpp"
#include "experiments/run/run_folder.hpp"
#include "platform/atomic_file.hpp"
#include "platform/clock.hpp"
#include "platform/interrupt.hpp"
#include "platform/program.hpp"
#include "platform/text.hpp"

namespace ballast {

// How far a plan is, over all its runs.

PlanProgress::PlanProgress(StatusLine::Style style, const std::vector<Task>& tasks)
    : line_(style, std::cerr), tasks_(tasks) {
  for (const Task& task : tasks) all_work_ += task.work;
  work_before_ = work_done();
}

double PlanProgress::work_done() const {
  // A run that goes on counts by its steps; a deposit counts when it is through.
  double done = 0.0;
  for (const Task& task : tasks_) {
    if (task.state == TaskState::finished)
      done += task.work;
    else if (task.is_run() && task.steps > 0)
      done += task.work * std::min(1.0, static_cast<double>(steps_in_log(task.folder)) /
                                            static_cast<double>(task.steps));
  }
  return done;
}

std::string PlanProgress::text(double now) const {
  size_t runs = 0, finished = 0, failed = 0, running = 0, deposits = 0;
  for (const Task& task : tasks_) {
    runs += task.is_run();
    finished += task.is_run() && task.state == TaskState::finished;
    failed += task.is_run() && task.state == TaskState::failed;
    running += task.is_run() && task.state == TaskState::running;
    deposits += !task.is_run() && task.state == TaskState::running;
  }
  // What is left takes as long as what was done since the beginning, in proportion to the work.
  const double done = work_done(), gained = done - work_before_;
  const double fraction = all_work_ > 0.0 ? done / all_work_ : 1.0;
  std::string text = line_.style() == StatusLine::Style::bar ? bar_text(fraction) : "";
  text += printed("%3.0f %%  %zu of %zu runs, %zu running", std::floor(100.0 * fraction), finished,
                  runs, running);
  if (deposits > 0) text += ", " + std::to_string(deposits) + " depositing";
  if (failed > 0) text += ", " + std::to_string(failed) + " FAILED";
  if (gained > 0.0) text += "  " + duration_text(now * (all_work_ - done) / gained) + " left";
  return text;
}

void PlanProgress::show(double now) {
  const double interval =
      3.0 * line_.interval();  // hours rather than minutes: half a minute between lines
  if (line_.style() == StatusLine::Style::quiet || now < written_ + interval) return;
  written_ = now;
  line_.write(text(now));
}

void PlanProgress::say(const std::string& text) {
  line_.end();
  if (line_.style() != StatusLine::Style::quiet) std::cout << text << std::endl;
}

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
  Task task{.title = run.run.name,
            .key = run.key,
            .folder = run_folder(results, run),
            .log = results / "logs" / (run.key + ".log"),
            .arguments = run_arguments(results, run),
            .steps = run.steps,
            .work = run.work};
  if (is_finished(task.folder, run.key)) task.state = TaskState::finished;
  return task;
}

Task deposit_task(const fs::path& results, const ResolvedRun& run) {
  return {.title = "packing of " + run.run.name,
          .key = run.packing,
          .log = results / "logs" / ("packing-" + run.packing + ".log"),
          .arguments = deposit_arguments(results, run),
          .work = run.packing_work};
}

void sort_by_work(std::vector<Task>& tasks) {
  std::stable_sort(tasks.begin(), tasks.end(),
                   [](const Task& a, const Task& b) { return a.work > b.work; });
}

}  // namespace

std::vector<Task> make_tasks(const fs::path& results, const std::vector<ResolvedRun>& runs) {
  std::vector<Task> drives, tasks;
  std::map<std::string, std::string> packing_of;  // of a run that waits for it
  std::set<std::string> seen;  // two names may be one run, and several runs have one packing
  for (const ResolvedRun& run : runs) {
    if (!seen.insert(run.key).second) continue;
    drives.push_back(run_task(results, run));
    const bool needs_packing = drives.back().state != TaskState::finished && !run.packing.empty() &&
                               !is_there(packing_file(packing_folder(results), run.packing));
    if (!needs_packing) continue;
    packing_of[run.key] = run.packing;
    if (seen.insert(run.packing).second) tasks.push_back(deposit_task(results, run));
  }
  // of deposits and of drives the longest come first, so that no long one is left for the end
  sort_by_work(tasks);
  sort_by_work(drives);
  const size_t deposits = tasks.size();
  for (Task& task : drives) {
    if (const auto packing = packing_of.find(task.key); packing != packing_of.end())
      for (size_t k = 0; k < deposits; ++k)
        if (tasks[k].key == packing->second) task.deposit = static_cast<int>(k);
    tasks.push_back(std::move(task));
  }
  return tasks;
}

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
        for (const auto& [task, worker] : workers_) worker->send(SIGTERM);
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
      workers_.emplace(k, start_program(program_, task.arguments, task.log));
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
  std::map<size_t, std::unique_ptr<ChildProcess>> workers_;  // by task
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

ExitCode run_plan(const Plan& plan, const PlanOptions& options) {
  // everything that can be wrong with the plan is found before anything is written
  const std::vector<ResolvedRun> all = resolve(plan);
  const std::vector<ResolvedRun> chosen = resolve({plan.name, select(plan, options.only)});
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
