#pragma once
// Tables as comma-separated values (RFC 4180): cells with a comma or a quote stand in quotes. A
// cell is one line: line ends in it become blanks.

#include <filesystem>
#include <initializer_list>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace ballast {

/// Writes rows into a text.
class CsvWriter {
 public:
  void add(std::string_view cell);
  /// `digits` is as in printf's %g; 17 keep every bit.
  void add(double value, int digits);
  void add(long value);
  void end_row();
  void add_row(std::span<const std::string> cells);
  void add_row(std::initializer_list<std::string> cells) { add_row(std::span(cells)); }

  /// Returns the text that was written since the last call.
  std::string take() { return std::exchange(text_, {}); }

 private:
  std::string text_;
  bool in_row_ = false;
};

/// A number as a cell, with `digits` as in printf's %g; empty where it is not finite.
std::string number_cell(double value, int digits);

/// Reads a file row by row; empty lines are skipped.
class CsvReader {
 public:
  /// Throws Error when the file cannot be read.
  explicit CsvReader(const std::filesystem::path& file);

  /// Goes to the next row; false after the last.
  bool next();
  /// The cells of this row, without their quotes; valid until next().
  std::span<const std::string> cells() const { return cells_; }
  /// A cell as a number. Throws Error naming `column` when it is none.
  double number(size_t cell, std::string_view column) const;
  /// Throws Error unless the row has `count` cells.
  void require_cells(size_t count) const;
  /// Throws Error "<file>:<line>: <what>".
  [[noreturn]] void fail(const std::string& what) const;

 private:
  void split(std::string_view line);

  std::string file_, text_;
  size_t at_ = 0;  // where the next line begins in text_
  long line_ = 0;
  std::vector<std::string> cells_;
};

}  // namespace ballast
