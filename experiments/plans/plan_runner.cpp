#include "experiments/plans/plan_runner.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <iostream>
#include <map>
#include <memory>

#include <signal.h>
#include <unistd.h>

#include "experiments/box/packing.hpp"
#include "experiments/run/run_folder.hpp"
#include "platform/clock.hpp"
#include "platform/csv.hpp"
#include "platform/interrupt.hpp"
#include "platform/program.hpp"
#include "platform/row_log.hpp"
#include "platform/text.hpp"
#include "problems/scene/scene_file.hpp"

namespace ballast {

namespace fs = std::filesystem;

fs::path run_folder(const fs::path& results, const PlannedRun& run) {
  return results / "runs" / run.key;
}
fs::path packing_folder(const fs::path& results) { return results / "packings"; }

namespace {

void make_folders(const fs::path& results) {
  for (const char* name : {"runs", "packings", "logs"}) create_folder(results / name);
}

/// Arguments of the ballast program that begin or continue the run, or only make its packing.
std::vector<std::string> run_arguments(const fs::path& results, const PlannedRun& run,
                                       bool deposit_only = false) {
  std::vector<std::string> words{"run", run.scene};
  for (const std::string& text : run.overrides) words.insert(words.end(), {"--set", text});
  words.insert(words.end(), {"--packing-cache", packing_folder(results).string()});
  if (deposit_only)
    words.push_back("--deposit-only");
  else
    words.insert(words.end(),
                 {"--output", run_folder(results, run).string(), "--continue", "--no-report"});
  return words;
}

long count(const std::vector<Task>& tasks, bool is_run, TaskState state) {
  return std::ranges::count_if(
      tasks, [&](const Task& task) { return task.is_run() == is_run && task.state == state; });
}

}  // namespace

long steps_in_log(const fs::path& run_folder) {
  try {
    return RowReader(RunFolder(run_folder).steps_log()).row_count();
  } catch (const Error&) {  // there is none, or it is just being made
    return 0;
  }
}

std::string state_of(const fs::path& results, const PlannedRun& run) {
  const RunFolder folder(run_folder(results, run));
  if (!folder.has_run()) return "waiting";
  try {
    return folder.is_finished(run.key) ? "finished" : "begun";
  } catch (const Error&) {
    return "begun";
  }
}

void write_index(const fs::path& results, const Plan& plan, const std::set<std::string>& failed) {
  const fs::path file = results / "index.csv";
  CsvWriter csv;
  csv.add_row(
      {"plan", "name", "key", "state", "steps_done", "steps", "seconds", "error_mean", "commit"});
  for (const PlannedRun& run : plan.runs) {
    const RunFolder folder(run_folder(results, run));
    const std::string state = failed.contains(run.key) ? "failed" : state_of(results, run);
    const long done =
        state == "finished" ? run.steps : std::min(run.steps, steps_in_log(folder.path()));
    std::vector<std::string> cells{
        plan.name, run.name, run.key, state, std::to_string(done), std::to_string(run.steps)};
    try {
      const Manifest manifest = Manifest::read(folder.manifest());
      for (const char* name : {"drive_seconds", "error_mean_relative"})
        cells.push_back(number_cell(manifest.summary_number(name), 6));
      cells.push_back(manifest.commit());
    } catch (const Error&) {  // not written yet, or damaged: the run itself will report it
      cells.resize(9);
    }
    csv.add_row(cells);
  }
  std::string text = csv.take();
  // Plans may share a folder: the one table has the runs of all plans that were run there.
  if (path_exists(file)) {
    const std::vector<std::string> rows = split(read_whole_file(file), '\n');
    for (size_t k = 1; k < rows.size(); ++k)
      if (!rows[k].empty() && !rows[k].starts_with(plan.name + ',')) text += rows[k] + '\n';
  }
  write_whole_file(file, text);
}

double work_done(const std::vector<Task>& tasks) {
  // A run that goes on counts by its steps; a deposit counts when it is finished.
  double done = 0.0;
  for (const Task& task : tasks) {
    if (task.state == TaskState::finished)
      done += task.work;
    else if (task.is_run() && task.steps > 0)
      done += task.work * std::min(1.0, 1.0 * steps_in_log(task.folder) / task.steps);
  }
  return done;
}

std::string plan_progress(const std::vector<Task>& tasks, double work_before, double seconds) {
  double all = 0.0;
  for (const Task& task : tasks) all += task.work;
  // The time left is in proportion to the work left, at the pace since the plan was taken up.
  const double done = work_done(tasks), gained = done - work_before;
  std::string text = printed(
      "%3.0f %%  %ld of %ld runs, %ld running", all > 0.0 ? std::floor(100.0 * done / all) : 100.0,
      count(tasks, true, TaskState::finished), std::ranges::count_if(tasks, &Task::is_run),
      count(tasks, true, TaskState::running));
  if (const long deposits = count(tasks, false, TaskState::running); deposits > 0)
    text += ", " + std::to_string(deposits) + " depositing";
  if (const long failed = count(tasks, true, TaskState::failed); failed > 0)
    text += ", " + std::to_string(failed) + " FAILED";
  if (gained > 0.0) text += "  " + duration_text(seconds * (all - done) / gained) + " left";
  return text;
}

std::vector<Task> make_tasks(const fs::path& results, std::vector<PlannedRun> runs) {
  std::vector<Task> tasks;
  // The longest deposits and the longest runs come first, so that no long one is left for the end.
  std::ranges::stable_sort(runs, std::greater(), &PlannedRun::packing_work);
  std::map<std::string, int> deposits;  // several runs may share one
  for (const PlannedRun& run : runs) {
    const bool needs_packing = !run.packing.empty() && state_of(results, run) != "finished" &&
                               !path_exists(packing_file(packing_folder(results), run.packing));
    if (needs_packing && deposits.emplace(run.packing, tasks.size()).second)
      tasks.push_back({.title = "packing of " + run.name,
                       .key = run.packing,
                       .log = results / "logs" / ("packing-" + run.packing + ".log"),
                       .arguments = run_arguments(results, run, true),
                       .work = run.packing_work});
  }
  std::ranges::stable_sort(runs, std::greater(), &PlannedRun::work);
  std::set<std::string> seen;  // two names may mean one run
  for (const PlannedRun& run : runs) {
    if (!seen.insert(run.key).second) continue;
    Task& task = tasks.emplace_back(Task{.title = run.name,
                                         .key = run.key,
                                         .folder = run_folder(results, run),
                                         .log = results / "logs" / (run.key + ".log"),
                                         .arguments = run_arguments(results, run),
                                         .steps = run.steps,
                                         .work = run.work});
    if (const auto deposit = deposits.find(run.packing); state_of(results, run) == "finished")
      task.state = TaskState::finished;
    else if (deposit != deposits.end())
      task.deposit = deposit->second;
  }
  return tasks;
}

std::vector<std::string> plan_commands(const Plan& plan, const PlanOptions& options) {
  const auto absolute = [](const fs::path& path) { return fs::absolute(path).lexically_normal(); };
  const fs::path results = absolute(options.results);
  std::vector<PlannedRun> runs = select(plan, options.only);
  for (PlannedRun& run : runs) run.scene = absolute(find_scene(run.scene));
  std::vector<std::string> lines;
  for (Task& task : make_tasks(results, runs)) {
    if (task.state == TaskState::finished) continue;
    task.arguments.insert(task.arguments.begin(), executable_path().string());
    lines.push_back(shell_line(task.arguments) + " >>" + shell_quoted(task.log.string()) + " 2>&1");
  }
  make_folders(results);
  return lines;
}

namespace {

/// Starts tasks in their order while processes are free, checks them two hundred times a second,
/// and reports the results.
class Engine {
 public:
  Engine(const Plan& plan, const PlanOptions& options, std::vector<Task> tasks)
      : plan_(plan), options_(options), tasks_(std::move(tasks)) {}

  ExitCode execute() {
    ExitCode stopped = ExitCode::ok;  // the reason to stop early; ok: none
    while (start_what_can(stopped == ExitCode::ok) || !workers_.empty()) {
      collect();
      if (stopped == ExitCode::ok &&
          (InterruptGuard::requested() || seconds() > options_.max_seconds)) {
        stopped = InterruptGuard::requested() ? ExitCode::failure : ExitCode::time_limit;
        // the workers write a checkpoint and end; the loop goes on until all have
        for (const auto& [task, worker] : workers_) worker->send(SIGTERM);
      }
      show();
      if (seconds() > indexed_ + 20.0) index();
      usleep(5000);
    }
    line_.end();
    index();
    return conclude(stopped);
  }

 private:
  double seconds() const { return watch_.seconds(); }

  /// Prints an event as a line on stdout.
  void say(const std::string& text) {
    line_.end();
    if (options_.style != StatusLine::Style::quiet) std::cout << text << std::endl;
  }

  void show() {
    // plans take hours rather than minutes: half a minute between lines
    if (options_.style == StatusLine::Style::quiet || seconds() < shown_ + 3.0 * line_.interval())
      return;
    shown_ = seconds();
    line_.write(plan_progress(tasks_, work_before_, shown_));
  }

  /// Returns false when no task was started. The runs of a failed deposit fail with it.
  bool start_what_can(bool may_start) {
    bool started = false;
    for (size_t k = 0; k < tasks_.size(); ++k) {
      Task& task = tasks_[k];
      if (task.state != TaskState::waiting) continue;
      const Task* deposit = task.deposit < 0 ? nullptr : &tasks_[static_cast<size_t>(task.deposit)];
      if (deposit && deposit->state == TaskState::failed) {
        task.log = deposit->log;  // it has none of its own
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
    std::erase_if(workers_, [&](const auto& worker) {
      const bool is_over = worker.second->has_ended();
      if (is_over) ended(worker.first, worker.second->status());
      return is_over;
    });
  }

  void ended(size_t k, int status) {
    Task& task = tasks_[k];
    if (status == static_cast<int>(ExitCode::ok)) {
      task.state = TaskState::finished;
      say("finished  " + task.title + "  " + duration_text(seconds() - begun_[k]));
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
    const std::string words = task.title + ": " + reason + " (" + task.log.string() + ")";
    if (failure_.empty()) failure_ = words;
    say("FAILED    " + words);
  }

  /// Writes index.csv, every twenty seconds and at the end. Only the engine knows the failed tasks.
  void index() {
    std::set<std::string> failed;
    for (const Task& task : tasks_)
      if (task.state == TaskState::failed) failed.insert(task.key);
    write_index(options_.results, plan_, failed);
    indexed_ = seconds();
  }

  /// Prints the results and how to go on.
  ExitCode conclude(ExitCode stopped) const {
    const long runs = std::ranges::count_if(tasks_, &Task::is_run),
               finished = count(tasks_, true, TaskState::finished),
               failed = count(tasks_, true, TaskState::failed);
    std::cout << runs << " runs: " << finished << " finished (" << finished_before_
              << " of them before)";
    if (failed > 0) std::cout << ", " << failed << " failed";
    if (runs > finished + failed) std::cout << ", " << runs - finished - failed << " to do";
    std::cout << "; see " << (options_.results / "index.csv").string() << std::endl;
    if (stopped == ExitCode::ok && failed == 0) return ExitCode::ok;
    std::cerr << "ballast: plan " << plan_.name << ": ";
    if (stopped == ExitCode::ok)
      std::cerr << failed << " of " << runs << " runs failed; first: " << failure_ << std::endl;
    else
      std::cerr << (stopped == ExitCode::time_limit ? "time limit reached" : "interrupted")
                << "; nothing is lost: the same command goes on" << std::endl;
    return stopped == ExitCode::ok ? ExitCode::failure : stopped;
  }

  const Plan& plan_;
  const PlanOptions& options_;
  fs::path program_ = executable_path();
  std::vector<Task> tasks_;
  long finished_before_ = count(tasks_, true, TaskState::finished);
  double work_before_ = work_done(tasks_);
  StatusLine line_{options_.style, std::cerr};
  Stopwatch watch_;
  double indexed_ = 0.0, shown_ = 0.0;
  std::string failure_;                                      // of the first that failed
  std::map<size_t, std::unique_ptr<ChildProcess>> workers_;  // by task
  std::map<size_t, double> begun_;
};

}  // namespace

ExitCode run_plan(const Plan& plan, const PlanOptions& options) {
  const std::vector<PlannedRun> chosen = select(plan, options.only);
  const InterruptGuard guard;
  make_folders(options.results);
  const FileLock lock(options.results / "plan.lock", briefly);
  lock.require_held();
  return Engine(plan, options, make_tasks(options.results, chosen)).execute();
}

}  // namespace ballast
