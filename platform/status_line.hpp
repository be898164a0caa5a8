#pragma once
// A line that says how far something is: rewrites itself on a terminal, is written now and then
// elsewhere.

#include <iosfwd>
#include <string>

namespace ballast {

class StatusLine {
 public:
  enum class Style {
    quiet,
    lines,
    bar,
    json,  ///< lines for programs, one a second: what is written is JSON
  };

  /// bar if stderr is a terminal, else lines.
  static Style style_of_stderr();

  /// `columns`: of what a bar is written to; 0: of the terminal where that is stderr.
  StatusLine(Style style, std::ostream& out, size_t columns = 0)
      : style_(style), out_(out), columns_(columns) {}
  ~StatusLine() { end(); }
  StatusLine(const StatusLine&) = delete;
  StatusLine& operator=(const StatusLine&) = delete;

  Style style() const { return style_; }
  /// Between two lines [s]: often where the line rewrites itself.
  double interval() const {
    return style_ == Style::bar ? 0.1 : style_ == Style::json ? 1.0 : 10.0;
  }

  /// What fits into a line; without a terminal there is no bound.
  size_t columns() const;

  void write(std::string text);
  /// Ends the line that is being rewritten, if one is: to be called before anything else is
  /// printed.
  void end();

 private:
  Style style_;
  std::ostream& out_;
  size_t columns_;
  bool open_ = false;
  size_t length_ = 0;  // in columns
};

/// Letters of a text in UTF-8, each of one column; and its first `columns` of them.
size_t columns_of(const std::string& text);
std::string cut_to(const std::string& text, size_t columns);

/// "[####........] "
std::string bar_text(double fraction);

}  // namespace ballast
