#include "experiments/page/plot_layout.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace ballast {
namespace {

KeySize key_size(const Figure& figure, const Panel& panel) {
  constexpr double letter = 10.6, sample = 5.3 * letter;
  double widest = 0.0;
  int entries = 0;
  for (const Curve& curve : panel.curves) {
    if (curve.title.empty()) continue;
    ++entries;
    const auto letters = std::count_if(curve.title.begin(), curve.title.end(),
                                       [](unsigned char c) { return (c & 0xc0) != 0x80; });
    widest = std::max(widest, sample + letter * static_cast<double>(letters));
  }
  // as many columns as fit beside each other
  if (entries == 0) return {};
  KeySize size;
  size.columns = std::clamp(static_cast<int>((figure.width - left_margin - right_margin) / widest),
                            1, entries);
  size.rows = (entries + size.columns - 1) / size.columns;
  return size;
}

}  // namespace

void Extent::add(double value) {
  if (!std::isfinite(value) || (is_log && value <= 0.0)) return;
  low = std::min(low, value);
  high = std::max(high, value);
}

void Extent::pad(double margin) {
  if (is_log) {
    const double first = std::log10(low), last = std::log10(high), more = margin * (last - first);
    const bool has_marks = std::floor(last + more) - std::ceil(first - more) >= 1.0;
    low = std::pow(10.0, has_marks ? first - more : std::floor(first - 1e-9));
    high = std::pow(10.0, has_marks ? last + more : std::ceil(last + 1e-9));
    return;
  }
  // a constant gets room above and below
  const double span = high > low ? high - low : std::max(std::abs(high) * 0.1, 1e-9);
  if (high == low) {
    low -= 0.5 * span;
    high += 0.5 * span;
  }
  low -= margin * span;
  high += margin * span;
}

Extent y_extent(const Panel& panel) {
  Extent extent{panel.log_y};
  for (const Curve& curve : panel.curves)
    for (size_t k = 0; k < curve.y.size(); ++k) {
      if (!std::isfinite(curve.x[k])) continue;
      const double bar = curve.y_error.empty() ? 0.0 : curve.y_error[k];
      extent.add(curve.y[k] - bar);
      extent.add(curve.y[k] + bar);
      if (!curve.y_low.empty()) extent.add(curve.y_low[k]);
    }
  if (extent.is_empty()) throw std::invalid_argument("nothing to draw for " + panel.y_label);
  for (const ReferenceLine& line : panel.lines)
    if (!line.vertical) extent.add(line.value);
  extent.pad(0.06);
  if (panel.y_min) extent.low = *panel.y_min;
  if (panel.y_max) extent.high = *panel.y_max;
  return extent;
}

Extent x_extent(const Panel& panel) {
  Extent extent{panel.log_x};
  for (const Curve& curve : panel.curves)
    for (double x : curve.x) extent.add(x);
  if (extent.is_empty()) throw std::invalid_argument("nothing to draw along " + panel.x_label);
  if (!panel.x_min || !panel.x_max) extent.pad(0.03);
  if (panel.x_min) extent.low = *panel.x_min;
  if (panel.x_max) extent.high = *panel.x_max;
  return extent;
}

std::vector<PanelPlace> panel_places(const Figure& figure) {
  // numbers and x label below the last box, or below each when the axes differ
  const bool is_shared =
      std::all_of(figure.panels.begin(), figure.panels.end(),
                  [&](const Panel& panel) { return panel.x_label == figure.panels[0].x_label; });
  constexpr double above = 12.0, below_last = 66.0;
  const double below = is_shared ? 12.0 : below_last;
  const size_t count = figure.panels.size();
  // what keys, numbers and labels leave is shared evenly among the boxes
  double keys = 0.0;
  for (const Panel& panel : figure.panels) keys += key_row * key_size(figure, panel).rows;
  const double box = (figure.height - keys - static_cast<double>(count) * above - below_last -
                      static_cast<double>(count - 1) * below) /
                     static_cast<double>(count);
  // from the top of the figure down
  std::vector<PanelPlace> places;
  double y = figure.height;
  for (size_t p = 0; p < count; ++p) {
    const KeySize key = key_size(figure, figure.panels[p]);
    y -= above + key_row * key.rows;
    places.push_back({y, y - box, !is_shared || p + 1 == count, key});
    y -= box + below;
  }
  return places;
}

}  // namespace ballast
