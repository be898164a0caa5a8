#pragma once
// A line that shows progress: it is rewritten in place on a terminal, and written from time to time
// elsewhere.

#include <iosfwd>
#include <string>

namespace ballast {

class StatusLine {
 public:
  enum class Style { quiet, lines, bar };

  /// bar if stderr is a terminal, else lines.
  static Style style_of_stderr();

  StatusLine(Style style, std::ostream& out) : style_(style), out_(out) {}
  ~StatusLine() { end(); }
  StatusLine(const StatusLine&) = delete;
  StatusLine& operator=(const StatusLine&) = delete;

  Style style() const { return style_; }
  /// Time between two lines [s]; short where the line is rewritten.
  double interval() const { return style_ == Style::bar ? 0.1 : 10.0; }

  void write(const std::string& text);
  /// Ends the line that is being rewritten, if there is one. Must be called before anything else is
  /// printed.
  void end();

 private:
  Style style_;
  std::ostream& out_;
  bool open_ = false;
};

/// "[####........] "
std::string bar_text(double fraction);

}  // namespace ballast
