#pragma once
// A plot in one line of a terminal: a quantity over a run so far, in blocks of eighths.

#include <array>
#include <cstddef>
#include <limits>
#include <string>

namespace ballast {

class Trace {
 public:
  explicit Trace(bool is_log = false);

  /// The value at `fraction` of the run, from 0 to 1; what a plot cannot show is left out.
  void add(double fraction, double value);

  /// So many columns for the whole run, from its least to its largest value; blanks for what is
  /// not known (yet).
  std::string text(size_t columns) const;

  /// There is nothing to see: fewer than two different values.
  bool is_flat() const;

 private:
  struct Range {
    double least = std::numeric_limits<double>::infinity(), most = -least;
  };
  Range range() const;

  bool is_log_;
  std::array<double, 48> values_;  ///< the last in each equal part of the run; NaN: none
};

/// The locale of this process writes Unicode (LC_ALL, LC_CTYPE, LANG).
bool writes_unicode();

}  // namespace ballast
