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

size_t StatusLine::columns() const {
  if (columns_ > 0) return columns_;
  return &out_ == &std::cerr ? terminal_columns() : std::string::npos;
}

void StatusLine::write(std::string text) {
  if (style_ == Style::quiet) return;
  if (style_ == Style::bar) {
    text = cut_to(text, columns());
    const size_t length = columns_of(text);
    // Back to the first column; blanks cover what the longer line before has left.
    out_ << '\r' << text;
    if (length < length_) out_ << std::string(length_ - length, ' ');
    open_ = true;
    length_ = length;
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

size_t columns_of(const std::string& text) {
  return static_cast<size_t>(
      std::count_if(text.begin(), text.end(), [](char c) { return (c & 0xC0) != 0x80; }));
}

std::string cut_to(const std::string& text, size_t columns) {
  size_t end = 0, count = 0;
  for (; end < text.size(); ++end)
    if ((text[end] & 0xC0) != 0x80 && count++ == columns) break;
  return text.substr(0, end);
}

std::string bar_text(double fraction) {
  constexpr int width = 12;
  const int full = static_cast<int>(width * std::clamp(fraction, 0.0, 1.0));
  return std::string("[").append(full, '#').append(width - full, '.').append("] ");
}

}  // namespace ballast
