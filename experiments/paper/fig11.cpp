// Fig. 11 and Eq. 3: all that is varied on one line?

#include <algorithm>
#include <cmath>

#include "experiments/paper/sections.hpp"

namespace ballast {
namespace {

/// One thing varied: its points have a colour, and a row of the table.
struct Branch {
  Varied varied;
  const char *name, *title;  ///< in words, and in the legend
  Ink ink;
};
constexpr Branch branches[] = {{Varied::frequency, "ν", "ν", Ink::blue},
                               {Varied::force, "f_max", "f_{max}", Ink::vermilion},
                               {Varied::gravity, "g", "g", Ink::green},
                               {Varied::wall_mass, "m_w", "m_w", Ink::purple}};

/// Points of one thing varied: right side of Eq. 3 and Delta x_max, in mm.
VariedCurve points_on_eq3(const std::vector<VariedValue>& values) {
  VariedCurve points;
  for (const VariedValue& value : values) {
    const SampleMean rise = value.mean(&Observation::rise);
    if (!std::isfinite(rise.mean)) continue;
    std::vector<double> sides;
    for (const Observation& sample : value.samples) sides.push_back(sample.eq3());
    points.x.push_back(1e3 * sample_mean(sides).mean);
    points.y.push_back(1e3 * rise.mean);
    points.error.push_back(1e3 * rise.error);
  }
  return points;
}

VariedCurve together(const std::vector<VariedCurve>& parts) {
  VariedCurve all;
  for (const VariedCurve& part : parts) {
    all.x.insert(all.x.end(), part.x.begin(), part.x.end());
    all.y.insert(all.y.end(), part.y.begin(), part.y.end());
    all.error.insert(all.error.end(), part.error.begin(), part.error.end());
  }
  return all;
}

Panel eq3_panel(const std::vector<VariedCurve>& parts, const VariedCurve& all, double factor,
                bool is_log) {
  Panel panel{.x_label = is_log ? "right side of Eq. 3 without {/:Italic C}  (mm)"
                                : "the same, linear  (mm)",
              .y_label = "Δ{/:Italic x}_{max}  (mm)",
              .log_x = is_log,
              .log_y = is_log};
  // the points of each series in its colour
  for (size_t b = 0; b < parts.size(); ++b)
    if (!parts[b].x.empty())
      panel.curves.push_back(points_of(parts[b], branches[b].title, branches[b].ink));
  // our line and the paper's, over the range of all points
  const auto [low, high] = std::minmax_element(all.x.begin(), all.x.end());
  const auto line = [&, range = Drawn{is_log ? *low : 0.0, *high, is_log}](
                        double prefactor, const std::string& title, Ink ink) {
    panel.curves.push_back(curve_of([=](double x) { return prefactor * x; }, range, title, ink));
  };
  line(factor, "C = " + plot_label(page::number(factor)), Ink::black);
  line(paper::prefactor, "the paper’s C = 0.01", Ink::grey);
  return panel;
}

/// C with m the mean mass of one grain.
double prefactor_by_grain(const std::vector<VariedValue>& values) {
  std::vector<double> x, y;
  for (const VariedValue& value : values)
    for (const Observation& sample : value.samples) {
      x.push_back(sample.eq3_one_grain());
      y.push_back(sample.rise);
    }
  return fit_proportion(x, y).factor;
}

/// Slope of the line through the origin on linear axes, as one draws it through the paper's Fig.
/// 11: its largest points decide.
double linear_prefactor(const VariedCurve& points) {
  return project(points.x, points.y, [](double x) { return x; }).amplitude;
}

VariedCurve without_largest(VariedCurve points) {
  const auto k = std::max_element(points.x.begin(), points.x.end()) - points.x.begin();
  points.x.erase(points.x.begin() + k);
  points.y.erase(points.y.begin() + k);
  return points;
}

/// The paper gives one digit: within 30 % agrees, within a factor of 2.5 is of the same order.
Agreement judge_prefactor(double factor, double low, double high, int points) {
  if (points < 5) return Agreement::reported;
  const double ratio = factor / paper::prefactor;
  const bool is_inside = low <= paper::prefactor && paper::prefactor <= high;
  return graded((ratio > 0.7 && ratio < 1.3) || is_inside, ratio > 0.4 && ratio < 2.5);
}

}  // namespace

PaperSection fig11_section(PaperData& data) {
  PaperSection section{.text = {page::words("fig11.intro")}};
  page::Table table = page::words_table("fig11.table");
  std::vector<VariedCurve> parts;
  double by_grain = not_known;
  for (const Branch& branch : branches) {
    const std::vector<VariedValue> values = read_values(data, branch.varied, section);
    if (branch.varied == Varied::frequency) by_grain = prefactor_by_grain(values);
    const VariedCurve& points = parts.emplace_back(points_on_eq3(values));
    const Proportion line = fit_proportion(points.x, points.y);
    const PowerFit power = fit_power(points.x, points.y);
    table.rows.push_back({branch.name, std::to_string(line.samples), page::number(line.factor),
                          page::interval(line.low, line.high), page::number(line.spread),
                          words_of(power), misfit_words(power, points)});
  }
  // all series as one: a law without a free exponent, and one with
  const VariedCurve all = together(parts);
  if (all.x.empty()) return section;
  const Proportion line = fit_proportion(all.x, all.y);
  const PowerFit power = fit_power(all.x, all.y);
  const double linear = linear_prefactor(all);
  const page::Values words{{"C", page::number(line.factor)},
                           {"interval", page::interval(line.low, line.high)},
                           {"spread", page::number(line.spread)},
                           {"exponent", words_of(power)},
                           {"misfit", misfit_words(power, all)},
                           {"meaning", page::words("misfit")},
                           {"grain", page::number(by_grain)},
                           {"linear", page::number(linear)},
                           {"without", page::number(linear_prefactor(without_largest(all)))}};
  section.draw("fig11",
               {.height = 820,
                .panels = {eq3_panel(parts, all, line.factor, true),
                           eq3_panel(parts, all, line.factor, false)}},
               words);
  section.tables = {table};
  const bool is_known = line.samples > 4;
  section.claim("fig11.line", words,
                is_known ? graded(line.spread < 1.25, line.spread < 1.6) : Agreement::reported);
  section.claim("fig11.factor", words,
                judge_prefactor(line.factor, line.low, line.high, line.samples));
  if (is_known)
    section.claim("fig11.linear", words, judge_prefactor(linear, linear, linear, line.samples));
  return section;
}

}  // namespace ballast
