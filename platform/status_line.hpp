#pragma once
// A line that says how far something is: rewrites itself on a terminal, is written now and then
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
  /// Between two lines [s]: often where the line rewrites itself.
  double interval() const { return style_ == Style::bar ? 0.1 : 10.0; }

  void write(const std::string& text);
  /// Ends the line that is being rewritten, if one is: to be called before anything else is
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
