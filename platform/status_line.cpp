#include "platform/status_line.hpp"

#include <sys/ioctl.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <iostream>

namespace ballast {
namespace {

/// Of the terminal that stderr is: a longer line could not be rewritten. Asked each time, as
/// windows change.
size_t terminal_columns() {
  winsize window{};
  return ioctl(STDERR_FILENO, TIOCGWINSZ, &window) == 0 && window.ws_col > 1 ? window.ws_col - 1u
                                                                             : std::string::npos;
}

}  // namespace

StatusLine::Style StatusLine::style_of_stderr() {
  return isatty(STDERR_FILENO) ? Style::bar : Style::lines;
}

void StatusLine::write(std::string text) {
  if (style_ == Style::quiet) return;
  if (style_ == Style::bar) {
    if (&out_ == &std::cerr) text = text.substr(0, terminal_columns());
    out_ << '\r' << text;
    if (text.size() < length_) out_ << std::string(length_ - text.size(), ' ');
    open_ = true;
    length_ = text.size();
  } else {
    out_ << text << '\n';
  }
  out_ << std::flush;
}

void StatusLine::end() {
  if (open_) out_ << '\n' << std::flush;
  open_ = false;
  length_ = 0;
}

std::string duration_text(double seconds) {
  if (!(seconds < 1e6)) return "?";
  const long s = std::lround(seconds);
  char text[40];
  if (s < 60)
    std::snprintf(text, sizeof text, "%ld s", s);
  else if (s < 3600)
    std::snprintf(text, sizeof text, "%ld min %02ld s", s / 60, s % 60);
  else
    std::snprintf(text, sizeof text, "%ld h %02ld min", s / 3600, s / 60 % 60);
  return text;
}

std::string bar_text(double fraction) {
  constexpr int width = 12;
  const int full = static_cast<int>(width * std::clamp(fraction, 0.0, 1.0));
  return std::string("[").append(full, '#').append(width - full, '.').append("] ");
}

}  // namespace ballast
