#include "experiments/compare/compare_figures.hpp"

#include <algorithm>
#include <cmath>

#include "platform/text.hpp"

namespace ballast {
namespace {

/// "cold_1e-08": no two tolerances alike.
std::string suffix_of(const CompareTable& table) {
  std::string text = printed("%.0e", table.tolerance);
  if (parsed_number(text) != table.tolerance) text = printed("%g", table.tolerance);
  return std::string(name_of(table.start)) + "_" + figure_name(text);
}

/// Whole decade at or above.
double decade_above(double value) { return std::pow(10.0, std::ceil(std::log10(value) - 1e-9)); }
double decade_below(double value) { return std::pow(10.0, std::floor(std::log10(value) + 1e-9)); }

/// Least and largest of what was reached and cost anything; {not_reached, 0} without any.
std::pair<double, double> range_of(const CompareCosts& costs) {
  std::pair<double, double> range{not_reached, 0.0};
  for (const std::vector<double>& line : costs)
    for (const double cost : line) {
      if (!std::isfinite(cost) || !(cost > 0.0)) continue;
      range = {std::min(range.first, cost), std::max(range.second, cost)};
    }
  return range;
}

/// Adds the corners of a step curve, held up to `last`, to a curve.
Curve stairs(const StepCurve& steps, double last, Curve curve) {
  for (size_t k = 0; k < steps.x.size(); ++k) {
    if (k > 0) {
      curve.x.push_back(steps.x[k]);
      curve.y.push_back(steps.y[k - 1]);
    }
    curve.x.push_back(steps.x[k]);
    curve.y.push_back(steps.y[k]);
  }
  curve.x.push_back(last);
  curve.y.push_back(steps.y.back());
  return curve;
}

page::Picture profile(const CompareTable& table, const std::string& name, const std::string& title,
                      const std::string& x_label, const CompareCosts& costs, double first,
                      double last) {
  Panel panel{.x_label = x_label,
              .y_label = "fraction of cases solved",
              .log_x = true,
              .y_min = 0.0,
              .y_max = 1.02,
              .x_min = first,
              .x_max = last};
  for (const StepCurve& steps : cost_profiles(costs, first, last)) {
    const size_t s = panel.curves.size();
    panel.curves.push_back(stairs(steps, last, backend_curve(s, table.solvers[s])));
  }
  Figure figure{.name = name + "_" + suffix_of(table), .title = title};
  figure.height = height_for(panel.curves.size());
  figure.panels = {panel};
  const page::Text words = page::words(
      "compare.table", {{"tolerance", page::exact(table.tolerance)},
                        {"start", name_of(table.start)},
                        {"cases", page::exact(static_cast<double>(table.cases.size()))}});
  return {figure, {page::words(name + ".caption", {{"table", words}})}};
}

}  // namespace

Curve backend_curve(size_t k, const std::string& title) {
  constexpr Ink inks[] = {Ink::blue,   Ink::vermilion, Ink::green, Ink::orange,
                          Ink::purple, Ink::sky,       Ink::black, Ink::grey};
  constexpr size_t count = std::size(inks);
  Curve curve;
  curve.title = plain_text(title);
  curve.ink = inks[k % count];
  curve.dashed = (k / count) % 2 == 1;
  curve.width = k < 2 * count ? 1.8 : 0.9;
  return curve;
}

void add_marked_line(const std::vector<std::pair<double, double>>& points, Curve curve,
                     Panel& panel) {
  for (const auto& [x, y] : points) {
    curve.x.push_back(x);
    curve.y.push_back(y);
  }
  panel.curves.push_back(curve);
  curve.title.clear();
  curve.mark = Mark::points;
  panel.curves.push_back(std::move(curve));
}

int height_for(size_t entries) { return 440 + 22 * static_cast<int>(entries / 3); }

std::string figure_name(const std::string& text) {
  std::string name;
  for (const char c : text)
    name += std::isalnum(static_cast<unsigned char>(c)) || c == '-' ? c : '_';
  return name;
}

std::vector<page::Picture> profile_figures(const CompareTable& table) {
  const CompareCosts ratios = table.time_ratios(), times = table.times_per_contact();
  const auto [least, most] = range_of(times);
  if (!(most > 0.0)) return {};
  const double last_ratio = std::max(10.0, decade_above(range_of(ratios).second)),
               first = decade_below(least), last = std::max(10.0 * first, decade_above(most));
  return {profile(table, "performance", "Performance profile",
                  "time over the fastest backend’s time", ratios, 1.0, last_ratio),
          profile(table, "data", "Data profile", "time per contact  (s)", times, first, last)};
}

}  // namespace ballast
