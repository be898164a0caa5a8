#pragma once
// The progress of a run: one line that rewrites itself on a terminal, a line every ten seconds
// elsewhere, nothing when quiet.

#include <functional>
#include <iosfwd>
#include <limits>
#include <string>
#include <string_view>

#include "experiments/step/step_record.hpp"
#include "platform/status_line.hpp"

namespace ballast {

class Progress {
 public:
  using Style = StatusLine::Style;

  /// Writes to stderr.
  explicit Progress(Style style);
  /// `clock`: seconds from any origin, increasing.
  Progress(Style style, std::ostream& out, std::function<double()> clock);

  /// To be called after each step of the phase `label`, which lasts `total` [s]; NaN where that is
  /// not known. Each call counts as a step; rate and time left are measured from the first call of
  /// the phase. `rms_velocity` [m/s] is shown unless it is NaN. A call that is not due to write
  /// only reads the clock.
  void show(std::string_view label, double total, const StepRecord& record,
            double rms_velocity = std::numeric_limits<double>::quiet_NaN());

  /// Ends the line, if one is being rewritten, with the state shown last. To be called before
  /// anything else is printed. The next call of show() begins a phase.
  void finish();

 private:
  std::string line(double now) const;
  void write(double now);

  StatusLine line_;
  std::function<double()> clock_;
  long steps_ = -1;  // calls after the first of the phase; -1: no call yet
  double first_clock_ = 0.0, first_time_ = 0.0;
  double last_written_ = 0.0;  // on the clock
  bool stale_ = false;         // a state was shown after the last write
  // the state shown last
  std::string label_;
  double total_ = 0.0, velocity_ = 0.0;
  StepRecord record_;
};

}  // namespace ballast
