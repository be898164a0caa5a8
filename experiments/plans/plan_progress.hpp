#pragma once
// How far a plan is, over all its runs.

#include <string>
#include <vector>

#include "experiments/plans/tasks.hpp"
#include "platform/status_line.hpp"

namespace ballast {

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
