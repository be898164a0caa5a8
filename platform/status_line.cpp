#include "platform/status_line.hpp"

#include <sys/ioctl.h>
#include <unistd.h>

#include <algorithm>
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
    // Back to the first column; blanks cover what the longer line before has left.
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

std::string bar_text(double fraction) {
  constexpr int width = 12;
  const int full = static_cast<int>(width * std::clamp(fraction, 0.0, 1.0));
  return std::string("[").append(full, '#').append(width - full, '.').append("] ");
}

}  // namespace ballast
