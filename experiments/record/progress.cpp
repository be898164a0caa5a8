#include "experiments/record/progress.hpp"

#include <algorithm>
#include <cmath>
#include <iostream>

#include "platform/clock.hpp"
#include "platform/text.hpp"

namespace ballast {

Progress::Progress(Style style)
    : Progress(style, std::cerr, [watch = Stopwatch()] { return watch.seconds(); }) {}

Progress::Progress(Style style, std::ostream& out, std::function<double()> clock)
    : line_(style, out), clock_(std::move(clock)) {}

void Progress::show(std::string_view label, double total, const StepRecord& record,
                    double rms_velocity) {
  if (line_.style() == Style::quiet) return;
  if (label != label_) finish();
  const double now = clock_();
  if (++steps_ == 0) {
    first_clock_ = now;
    first_time_ = record.time;
    // a line at the first step would only say that nothing is known yet
    last_written_ = line_.style() == Style::bar ? now - line_.interval() : now;
  }
  label_.assign(label);
  total_ = total;
  velocity_ = rms_velocity;
  record_ = record;
  stale_ = true;
  if (now - last_written_ >= line_.interval()) write(now);
}

void Progress::finish() {
  if (stale_) write(clock_());
  line_.end();
  steps_ = -1;
}

std::string Progress::line(double now) const {
  const double elapsed = now - first_clock_, time = record_.time,
               fraction = total_ > 0.0 ? std::clamp(time / total_, 0.0, 1.0) : 0.0;
  std::string text = label_ + " ";
  if (line_.style() == Style::bar) text += bar_text(fraction);
  if (std::isnan(total_))
    text += printed("  ? %%  %.4g s", time);
  else
    text += printed("%3.0f %%  %.4g/%.4g s", std::floor(100.0 * fraction), time, total_);
  // the mean pace so far says how long the rest will take
  if (time > first_time_ && time < total_)
    text += "  " + duration_text(elapsed * (total_ - time) / (time - first_time_)) + " left";
  if (steps_ > 0) text += printed("  %.1f ms/step", 1e3 * elapsed / static_cast<double>(steps_));
  text += printed("  error %.1e m/s  %.0f contacts", record_.error_rms, record_.contacts);
  if (!std::isnan(velocity_)) text += printed("  %.1e m/s rms", velocity_);
  return text;
}

void Progress::write(double now) {
  line_.write(line(now));
  last_written_ = now;
  stale_ = false;
}

}  // namespace ballast
