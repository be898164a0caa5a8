#include "experiments/plans/plan_progress.hpp"

#include <algorithm>
#include <cmath>
#include <iostream>

#include "platform/text.hpp"

namespace ballast {

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

}  // namespace ballast
