#include "platform/status_line.hpp"

#include <unistd.h>

#include <algorithm>
#include <cstdlib>
#include <ostream>
#include <string_view>

namespace ballast {

StatusLine::Style StatusLine::style_of_stderr() {
  const char* terminal = std::getenv("TERM");
  const bool rewrites = terminal && std::string_view(terminal) != "dumb";
  return rewrites && isatty(STDERR_FILENO) ? Style::bar : Style::lines;
}

void StatusLine::write(const std::string& text) {
  if (style_ == Style::quiet) return;
  open_ = style_ == Style::bar;
  // The terminal goes back to the first column, wipes the line, and cuts text that is longer than
  // it: a line that continues in a second one could not be rewritten.
  if (open_)
    out_ << "\r\x1b[K\x1b[?7l" << text << "\x1b[?7h" << std::flush;
  else
    out_ << text << std::endl;
}

void StatusLine::end() {
  if (open_) out_ << std::endl;
  open_ = false;
}

std::string bar_text(double fraction) {
  constexpr int width = 12;
  const int full = static_cast<int>(width * std::clamp(fraction, 0.0, 1.0));
  return std::string("[").append(full, '#').append(width - full, '.').append("] ");
}

}  // namespace ballast
