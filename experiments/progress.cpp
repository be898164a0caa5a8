#include "experiments/progress.hpp"

#include <sys/ioctl.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <iostream>

namespace ballast {

namespace {

constexpr double bar_interval = 0.1, line_interval = 10.0;  // [s] of the clock

double steady_seconds() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

template <class... Values>
std::string formatted(const char* format, Values... values) {
  char text[160];
  std::snprintf(text, sizeof text, format, values...);
  return text;
}

std::string duration(double seconds) {
  if (!(seconds < 1e6)) return "?";
  const long s = std::lround(seconds);
  if (s < 60) return formatted("%ld s", s);
  if (s < 3600) return formatted("%ld min %02ld s", s / 60, s % 60);
  return formatted("%ld h %02ld min", s / 3600, s / 60 % 60);
}

std::string bar(double fraction) {
  constexpr int width = 12;
  const int full = static_cast<int>(width * fraction);
  return std::string("[").append(full, '#').append(width - full, '.').append("] ");
}

/// Of the terminal that stderr is: a longer line could not be rewritten. Asked each time, as windows change.
size_t terminal_columns() {
  winsize window{};
  return ioctl(STDERR_FILENO, TIOCGWINSZ, &window) == 0 && window.ws_col > 1 ? window.ws_col - 1u : std::string::npos;
}

}  // namespace

Progress::Progress(bool quiet)
    : Progress(quiet                   ? Style::quiet
               : isatty(STDERR_FILENO) ? Style::bar
                                       : Style::lines,
               std::cerr, steady_seconds) {}

Progress::Progress(Style style, std::ostream& out, std::function<double()> clock)
    : style_(style), out_(out), clock_(std::move(clock)) {}

Progress::~Progress() {
  if (line_open_) out_ << '\n' << std::flush;
}

void Progress::show(std::string_view label, double time, double total, const StepRecord& record, double rms_velocity) {
  if (style_ == Style::quiet) return;
  const double now = clock_();
  const bool first = !started_;
  if (first) {
    started_ = true;
    first_clock_ = now;
    first_time_ = time;
    // a line at the first step would only say that nothing is known yet
    last_written_ = style_ == Style::lines ? now : now - bar_interval;
  } else {
    ++steps_;
  }
  label_.assign(label);
  time_ = time;
  total_ = total;
  error_ = record.error_rms;
  contacts_ = record.contacts;
  velocity_ = rms_velocity;
  stale_ = true;
  if (now - last_written_ >= (style_ == Style::bar ? bar_interval : line_interval)) write(now);
}

void Progress::finish() {
  if (style_ == Style::quiet) return;
  if (stale_) write(clock_());
  if (line_open_) out_ << '\n' << std::flush;
  line_open_ = false;
  line_length_ = 0;
}

void Progress::restart() {
  finish();
  started_ = false;
  steps_ = 0;
}

std::string Progress::line(double now) const {
  const double elapsed = now - first_clock_, fraction = total_ > 0.0 ? std::clamp(time_ / total_, 0.0, 1.0) : 0.0;
  std::string text = label_ + " ";
  if (style_ == Style::bar) text += bar(fraction);
  text += formatted("%3.0f %%  %.4g/%.4g s", std::floor(100.0 * fraction), time_, total_);
  if (time_ > first_time_ && time_ < total_)
    text += "  " + duration(elapsed * (total_ - time_) / (time_ - first_time_)) + " left";
  if (steps_ > 0) text += formatted("  %.1f ms/step", 1e3 * elapsed / static_cast<double>(steps_));
  text += formatted("  error %.1e m/s  %.0f contacts", error_, contacts_);
  if (!std::isnan(velocity_)) text += formatted("  %.1e m/s rms", velocity_);
  return text;
}

void Progress::write(double now) {
  std::string text = line(now);
  if (style_ == Style::bar) {
    if (&out_ == &std::cerr) text = text.substr(0, terminal_columns());
    out_ << '\r' << text;
    if (text.size() < line_length_) out_ << std::string(line_length_ - text.size(), ' ');
    line_open_ = true;
    line_length_ = text.size();
  } else {
    out_ << text << '\n';
  }
  out_ << std::flush;
  last_written_ = now;
  stale_ = false;
}

}  // namespace ballast
