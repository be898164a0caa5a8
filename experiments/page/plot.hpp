#pragma once
// Plots by gnuplot; no other code runs it. A figure is plain data; its script holds the data too,
// so that `gnuplot figures/x.gnuplot > x.svg` makes the same picture again.

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "experiments/page/text.hpp"

namespace ballast {

/// Okabe and Ito's colour-blind-safe colours, and two greys. The page maps them to lighter ones on
/// a dark ground.
enum class Ink { black, blue, vermilion, green, orange, sky, purple, grey, light };
const char* rgb_of(Ink ink);  ///< "#rrggbb"

enum class Mark {
  line,         ///< NaN breaks the line
  marked_line,  ///< with a point at each value
  points,       ///< filled, of the curve's shape; with bars where y_error is given
  area,         ///< filled between y and y_low
};

enum class MarkShape { circle, triangle, square, diamond };

struct Curve {
  std::vector<double> x = {}, y = {};
  page::Text title = {};  ///< empty: not in the key
  Ink ink = Ink::blue;
  Mark mark = Mark::line;
  MarkShape shape = MarkShape::circle;
  double width = 1.6;  ///< of the line, or size of the points
  int dash = 0;        ///< 0: a whole line; 1 to 3: dashes, the larger the shorter
  double opacity = 1.0;
  std::vector<double> y_error = {};  ///< points: half length of the bars
  std::vector<double> y_low = {};    ///< area: lower bound

  void add(double at, double value) {
    x.push_back(at);
    y.push_back(value);
  }
};

/// A dashed line across the panel with a label at its end: a target, a reference.
struct ReferenceLine {
  double value = 0.0;
  page::Text label = {};
  bool vertical = false;
  Ink ink = Ink::grey;
};

struct Panel {
  page::Text x_label = {}, y_label = {};
  bool log_x = false, log_y = false;
  std::optional<double> y_min = {}, y_max = {}, x_min = {}, x_max = {};
  std::vector<Curve> curves = {};
  std::vector<ReferenceLine> lines = {};
  std::vector<double> x_ticks = {};  ///< with numbers, if log_x; empty: chosen by the range
};

struct Figure {
  std::string name = {};   ///< stem of its files: letters, digits, _ and -
  std::string title = {};  ///< for screen readers and the SVG's <title>; plain text
  int width = 900, height = 420;
  std::vector<Panel> panels = {};  ///< one above the other, x axes aligned; only the last shows its
                                   ///< x label if all share it
  bool has_letters = false;        ///< (a), (b) ... above the panels: for print
};

/// The gnuplot script, data included, which writes to standard output. Throws std::invalid_argument
/// when a panel has nothing to show.
std::string gnuplot_script(const Figure& figure);

/// The version line of the gnuplot on PATH ("gnuplot 5.4 patchlevel 4"); empty without gnuplot.
std::string gnuplot_version();

/// Writes folder/<name>.gnuplot and folder/<name>.svg, each whole or not at all, and returns the
/// SVG's text. gnuplot runs without a shell, reads no configuration and is ended after `seconds`.
/// Throws Error naming the figure; an older SVG of that name is removed in that case, too.
std::string render_svg(const Figure& figure, const std::filesystem::path& folder,
                       double seconds = 60.0);

/// Thins x, y out to at most `limit` samples that look the same: the least and the largest y of
/// each stretch, in their order; one NaN for a stretch of NaN. Does nothing if `limit` < 4.
void thin_out(std::vector<double>& x, std::vector<double>& y, size_t limit);

}  // namespace ballast
