#include "experiments/record/progress.hpp"

#include <algorithm>
#include <cmath>
#include <iostream>

#include <nlohmann/json.hpp>

#include "platform/clock.hpp"
#include "platform/text.hpp"

namespace ballast {
Progress::Progress(Telling telling)
    : Progress(telling == Telling::nobody    ? Style::quiet
               : telling == Telling::program ? Style::json
                                             : StatusLine::style_of_stderr(),
               telling == Telling::program ? std::cout : std::cerr,
               [watch = Stopwatch()] { return watch.seconds(); }) {}

Progress::Progress(Style style, std::ostream& out, std::function<double()> clock)
    : line_(style, out), clock_(std::move(clock)) {}

void Progress::show(std::string_view label, double time, double total, const StepRecord& record,
                    double rms_velocity) {
  if (line_.style() == Style::quiet) return;
  const double now = clock_();
  const bool first = !started_;
  if (first) {
    started_ = true;
    first_clock_ = now;
    first_time_ = time;
    // a line at the first step would only say that nothing is known yet
    last_written_ = line_.style() == Style::bar ? now - line_.interval() : now;
  } else {
    ++steps_;
  }
  label_.assign(label);
  time_ = time;
  total_ = total;
  error_ = record.error_rms;
  contacts_ = record.contacts;
  velocity_ = rms_velocity;
  x_ = record.wall_x;
  stale_ = true;
  if (now - last_written_ >= line_.interval()) write(now);
}

void Progress::finish() {
  if (line_.style() == Style::quiet) return;
  if (stale_) write(clock_());
  line_.end();
}

void Progress::restart() {
  finish();
  started_ = false;
  steps_ = 0;
}

double Progress::seconds_left(double now) const {
  // the mean pace so far says how long the rest will take
  return time_ > first_time_ && time_ < total_
             ? (now - first_clock_) * (total_ - time_) / (time_ - first_time_)
             : std::nan("");
}

std::string Progress::line(double now) const {
  const double elapsed = now - first_clock_,
               fraction = total_ > 0.0 ? std::clamp(time_ / total_, 0.0, 1.0) : 0.0;
  std::string text = label_ + " ";
  if (line_.style() == Style::bar) text += bar_text(fraction);
  if (std::isnan(total_))
    text += printed("  ? %%  %.4g s", time_);
  else
    text += printed("%3.0f %%  %.4g/%.4g s", std::floor(100.0 * fraction), time_, total_);
  if (const double left = seconds_left(now); !std::isnan(left))
    text += "  " + duration_text(left) + " left";
  if (steps_ > 0) text += printed("  %.1f ms/step", 1e3 * elapsed / static_cast<double>(steps_));
  text += printed("  error %.1e m/s", error_);
  text += printed("  %.0f contacts", contacts_);
  if (!std::isnan(velocity_)) text += printed("  %.1e m/s rms", velocity_);
  return text;
}

/// Names with their units; null where a number is not known.
std::string Progress::json(double now) const {
  const auto known = [](double value) {
    return std::isfinite(value) ? nlohmann::ordered_json(value) : nlohmann::ordered_json();
  };
  const double elapsed = now - first_clock_;
  const nlohmann::ordered_json line = {
      {"event", "progress"},
      {"phase", label_},
      {"time_s", known(time_)},
      {"total_s", known(total_)},
      {"seconds_left", known(seconds_left(now))},
      {"ms_per_step", known(steps_ > 0 ? 1e3 * elapsed / static_cast<double>(steps_) : NAN)},
      {"error_m_s", known(error_)},
      {"contacts", known(contacts_)},
      {"wall_x_m", known(x_)},
      {"rms_velocity_m_s", known(velocity_)}};
  return line.dump(-1, ' ', false, nlohmann::ordered_json::error_handler_t::replace);
}

void Progress::write(double now) {
  line_.write(line_.style() == Style::json ? json(now) : line(now));
  last_written_ = now;
  stale_ = false;
}

}  // namespace ballast
