// Fig. 11 and Eq. 3: all that is varied on one line?

#include <algorithm>
#include <cmath>

#include "experiments/page/page.hpp"
#include "experiments/paper/sections.hpp"

namespace ballast {
namespace {

struct Branch {
  Varied varied;
  const char* title;
  Ink ink;
};
constexpr Branch branches[] = {{Varied::frequency, "ν", Ink::blue},
                               {Varied::force, "f_{max}", Ink::vermilion},
                               {Varied::gravity, "g", Ink::green},
                               {Varied::wall_mass, "m_w", Ink::purple}};
constexpr const char* branch_names[] = {"ν", "f_max", "g", "m_w"};

/// Points of one thing varied: right side of Eq. 3 and Delta x_max [m].
VariedCurve points_on_eq3(const std::vector<VariedValue>& values) {
  VariedCurve points;
  for (const VariedValue& value : values) {
    const SampleMean rise = value.mean(&Observation::rise);
    if (!std::isfinite(rise.mean)) continue;
    std::vector<double> sides;
    for (const Observation& sample : value.samples) sides.push_back(sample.eq3());
    points.x.push_back(sample_mean(sides).mean);
    points.y.push_back(rise.mean);
    points.error.push_back(rise.error);
  }
  return points;
}

std::vector<double> scaled(std::vector<double> values, double factor) {
  for (double& value : values) value *= factor;
  return values;
}

Panel eq3_panel(const std::vector<VariedCurve>& all, const Proportion& line, bool is_log) {
  Panel panel;
  panel.x_label =
      is_log ? "right side of Eq. 3 without {/:Italic C}  (mm)" : "the same, linear  (mm)";
  panel.y_label = "Δ{/:Italic x}_{max}  (mm)";
  panel.log_x = panel.log_y = is_log;
  double low = 1e300, high = 0.0;
  for (size_t b = 0; b < all.size(); ++b) {
    if (all[b].x.empty()) continue;
    panel.curves.push_back(points_of(scaled(all[b].x, 1e3), scaled(all[b].y, 1e3),
                                     scaled(all[b].error, 1e3), branches[b].title,
                                     branches[b].ink));
    low = std::min(low, 1e3 * *std::min_element(all[b].x.begin(), all[b].x.end()));
    high = std::max(high, 1e3 * *std::max_element(all[b].x.begin(), all[b].x.end()));
  }
  if (!is_log) low = 0.0;
  panel.curves.push_back(curve_of([&](double x) { return line.factor * x; }, low, high, is_log,
                                  "C = " + plot_label(page::number(line.factor)), Ink::black));
  panel.curves.push_back(curve_of([](double x) { return 0.01 * x; }, low, high, is_log,
                                  "the paper’s C = 0.01", Ink::grey));
  return panel;
}

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
  if ((ratio > 0.7 && ratio < 1.3) || (low <= paper::prefactor && paper::prefactor <= high))
    return Agreement::agrees;
  return ratio > 0.4 && ratio < 2.5 ? Agreement::partly : Agreement::differs;
}

/// Whether all sweeps lie on one line, and what its factor C is.
std::vector<AgreementRow> rows_of(const VariedCurve& pooled, const Proportion& line,
                                  const PowerFit& power, double by_grain) {
  const bool is_line = line.samples > 4 && line.spread < 1.25;
  std::vector<AgreementRow> rows = {
      {"Fig. 11, Eq. 3", "one line through all sweeps",
       "spread about the line: factor " + page::number(line.spread) + "; exponent " +
           words_of(power) + ", " + misfit_words(power, pooled),
       line.samples < 5    ? Agreement::reported
       : is_line           ? Agreement::agrees
       : line.spread < 1.6 ? Agreement::partly
                           : Agreement::differs},
      {"Eq. 3", "C ~ 0.01",
       "C = " + page::number(line.factor) + " " + page::interval(line.low, line.high) +
           " (m all grains); " + page::number(by_grain) + " (m one grain)",
       judge_prefactor(line.factor, line.low, line.high, line.samples)}};
  if (line.samples < 5) return rows;
  const double linear = linear_prefactor(pooled);
  rows.push_back({"Eq. 3", "C ~ 0.01, as a line through a linear plot",
                  "C = " + page::number(linear) +
                      " by least squares on linear axes, where the largest displacement "
                      "decides; without it " +
                      page::number(linear_prefactor(without_largest(pooled))),
                  judge_prefactor(linear, linear, linear, line.samples)});
  return rows;
}

}  // namespace

PaperSection fig11_section(PaperData& data) {
  PaperSection section;
  section.text = {page::words("fig11.intro")};
  const char* names[] = {"frequencies", "values of f_max", "values of g", "values of m_w"};
  std::vector<VariedCurve> all;
  VariedCurve pooled;
  page::Table table{"C of each sweep by itself",
                    {"sweep", "points", "C", "95 % interval", "spread (factor)",
                     "exponent (1: proportional)", "of that fit"},
                    {}};
  double by_grain = not_known;
  for (size_t b = 0; b < 4; ++b) {
    note_missing(data, branches[b].varied, names[b], section);
    const std::vector<VariedValue> values = data.values(branches[b].varied);
    all.push_back(points_on_eq3(values));
    const VariedCurve& points = all.back();
    pooled.x.insert(pooled.x.end(), points.x.begin(), points.x.end());
    pooled.y.insert(pooled.y.end(), points.y.begin(), points.y.end());
    pooled.error.insert(pooled.error.end(), points.error.begin(), points.error.end());
    if (b == 0) by_grain = prefactor_by_grain(values);
    const Proportion line = fit_proportion(points.x, points.y);
    const PowerFit power = fit_power(points.x, points.y);
    table.rows.push_back({branch_names[b], std::to_string(line.samples), page::number(line.factor),
                          page::interval(line.low, line.high), page::number(line.spread),
                          words_of(power), misfit_words(power, points)});
  }
  if (pooled.x.empty()) return section;
  const Proportion line = fit_proportion(pooled.x, pooled.y);
  const PowerFit power = fit_power(pooled.x, pooled.y);
  PaperFigure figure;
  figure.plot.name = "fig11";
  figure.plot.title = "Maximum displacement against the right side of Equation 3";
  figure.plot.height = 820;
  figure.plot.panels = {eq3_panel(all, line, true), eq3_panel(all, line, false)};
  figure.paper = page::words("fig11.paper");
  figure.found = page::words("fig11.found", {{"C", page::number(line.factor)},
                                             {"interval", page::interval(line.low, line.high)},
                                             {"spread", page::number(line.spread)},
                                             {"exponent", words_of(power)},
                                             {"misfit", misfit_words(power, pooled)},
                                             {"meaning", page::words("misfit")},
                                             {"grain", page::number(by_grain)}});
  section.figures = {figure};
  section.tables = {table};
  section.rows = rows_of(pooled, line, power, by_grain);
  return section;
}

}  // namespace ballast
