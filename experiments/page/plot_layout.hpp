#pragma once
// What the axes of a figure show and where its panels stand: numbers alone, no gnuplot.

#include <vector>

#include "experiments/page/plot.hpp"

namespace ballast {

/// Pixels: beside the axes' boxes, and the height of one line of a key.
inline constexpr double left_margin = 98.0, right_margin = 22.0, key_row = 22.0;

/// What an axis must show.
struct Extent {
  bool is_log = false;
  double low = 1e300, high = -1e300;

  /// Takes in a value that the axis can show: finite, and positive where it is logarithmic.
  void add(double value);
  bool is_empty() const { return low > high; }
  /// `margin` of the span to both sides.
  void pad(double margin);
};

/// Ticks of a logarithmic axis: 1, 2, 5 of every decade, only the powers of ten where there are
/// many decades. Within the extent.
std::vector<double> log_ticks(const Extent& extent);
/// 1 to 9 of every decade within the extent: marked without a number.
std::vector<double> minor_log_ticks(const Extent& extent);

/// Of all curves, error bars and reference lines of a panel, padded; the panel's own limits where
/// it has them. Throw std::invalid_argument when there is nothing to show.
Extent x_extent(const Panel& panel);
Extent y_extent(const Panel& panel);

/// Columns and rows of a panel's key: all columns are as wide as the longest title (gnuplot's
/// rule), letters taken as wide as it takes them.
struct KeySize {
  int columns = 1, rows = 0;
};

struct PanelPlace {
  double left, right;  ///< pixels from the figure's left edge to the axes' box
  double top, bottom;  ///< pixels from the figure's lower edge to it
  bool shows_x;        ///< numbers and label below the x axis
  KeySize key;         ///< above the box
};

/// One place for each panel, from the top down; all boxes are of the same height.
std::vector<PanelPlace> panel_places(const Figure& figure);

}  // namespace ballast
