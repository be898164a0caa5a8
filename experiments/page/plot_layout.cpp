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
    // a constant gets a factor of two to both sides
    const double more = high > low ? margin * std::log(high / low) : std::log(2.0);
    low *= std::exp(-more);
    high *= std::exp(more);
    return;
  }
  // a constant gets room above and below; so does what differs in digits that no axis writes
  const double size = std::max(std::abs(low), std::abs(high));
  const bool is_constant = high - low <= std::max(1e-6 * size, 1e-100);
  const double span = is_constant ? std::max(size * 0.1, 1e-9) : high - low;
  if (is_constant) {
    low -= 0.5 * span;
    high += 0.5 * span;
  }
  low -= margin * span;
  high += margin * span;
}

std::vector<double> minor_log_ticks(const Extent& extent) {
  std::vector<double> ticks;
  for (double decade = std::floor(std::log10(extent.low)); std::pow(10.0, decade) < extent.high;
       ++decade)
    for (int digit = 1; digit < 10; ++digit) {
      const double tick = digit * std::pow(10.0, decade);
      if (tick >= extent.low * (1.0 - 1e-9) && tick <= extent.high * (1.0 + 1e-9))
        ticks.push_back(tick);
    }
  return ticks;
}

std::vector<double> log_ticks(const Extent& extent) {
  const double decades = std::log10(extent.high / extent.low);
  constexpr double many = 3.0;
  std::vector<double> ticks = minor_log_ticks(extent);
  // the first digit of each decides; over less than half a decade all are numbered
  std::erase_if(ticks, [&](double tick) {
    const long digit = std::lround(tick / std::pow(10.0, std::floor(std::log10(tick * 1.0001))));
    return decades >= many ? digit != 1 : decades > 0.5 && digit != 1 && digit != 2 && digit != 5;
  });
  return ticks;
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
      std::all_of(figure.panels.begin(), figure.panels.end(), [&](const Panel& panel) {
        return panel.is_inset || panel.x_label == figure.panels[0].x_label;
      });
  constexpr double above = 12.0, below_last = 66.0;
  const double below = is_shared ? 12.0 : below_last;
  // what keys (and letters, which stand beside them), numbers and labels leave is shared evenly
  // among the boxes; an inset takes no room
  size_t count = 0;
  double keys = 0.0;
  std::vector<KeySize> sizes;
  for (const Panel& panel : figure.panels) {
    KeySize& key = sizes.emplace_back(key_size(figure, panel));
    if (figure.has_letters) key.rows = std::max(key.rows, 1);
    if (panel.is_inset) continue;
    keys += key_row * key.rows;
    ++count;
  }
  const double box = (figure.height - keys - static_cast<double>(count) * above - below_last -
                      static_cast<double>(count - 1) * below) /
                     static_cast<double>(count);
  // from the top of the figure down
  std::vector<PanelPlace> places;
  double y = figure.height;
  const double right = figure.width - right_margin;
  for (size_t p = 0, boxes = 0; p < sizes.size(); ++p) {
    if (figure.panels[p].is_inset) {
      const PanelPlace& outer = places.back();
      const double width = outer.right - outer.left, height = outer.top - outer.bottom;
      places.push_back({outer.left + 0.09 * width, outer.left + 0.47 * width,
                        outer.top - 0.05 * height, outer.bottom + 0.45 * height, true, sizes[p]});
      continue;
    }
    ++boxes;
    y -= above + key_row * sizes[p].rows;
    places.push_back({left_margin, right, y, y - box, !is_shared || boxes == count, sizes[p]});
    y -= box + below;
  }
  return places;
}

}  // namespace ballast
