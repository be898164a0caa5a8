// Fig. 11 and Eq. 3: all that is varied on one line?

#include <algorithm>
#include <cmath>

#include "experiments/paper/one_curve.hpp"

namespace ballast {
namespace {

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
    points.errors_from += rise.samples - 1;
    points.origins.push_back(value.origin());
  }
  return points;
}

VariedCurve together(const std::vector<VariedCurve>& parts) {
  VariedCurve all;
  for (const VariedCurve& part : parts) {
    all.x.insert(all.x.end(), part.x.begin(), part.x.end());
    all.y.insert(all.y.end(), part.y.begin(), part.y.end());
    all.error.insert(all.error.end(), part.error.begin(), part.error.end());
    all.errors_from += part.errors_from;
  }
  return all;
}

/// How Fig. 11 is drawn: logarithmic, linear as the paper's, and the linear one near the origin as
/// in the paper's inset.
enum class View { logarithmic, linear, origin };

Panel eq3_panel(const std::vector<VariedCurve>& parts, const VariedCurve& all, double factor,
                View view) {
  const bool is_log = view == View::logarithmic, is_inset = view == View::origin;
  Panel panel{.x_label = is_inset ? ""
                         : is_log ? "right side of Eq. 3 without {/:Italic C}  (mm)"
                                  : "right side of Eq. 3 without {/:Italic C}, linear  (mm)",
              .y_label = is_inset ? "" : "Δ{/:Italic x}_{max}  (mm)",
              .log_x = is_log,
              .log_y = is_log,
              .is_inset = is_inset};
  // near the origin: three quarters of the points
  std::vector<double> sorted = all.x;
  std::sort(sorted.begin(), sorted.end());
  const double high = is_inset ? quantile_of_sorted(sorted, 0.75) : sorted.back();
  // the points of each series in its colour and with the paper's mark
  for (size_t b = 0; b < parts.size(); ++b) {
    VariedCurve shown;
    for (size_t k = 0; k < parts[b].x.size(); ++k) {
      if (parts[b].x[k] > high) continue;
      shown.x.push_back(parts[b].x[k]);
      shown.y.push_back(parts[b].y[k]);
      shown.error.push_back(parts[b].error[k]);
      shown.origins.push_back(parts[b].origins[k]);
    }
    if (shown.x.empty()) continue;
    Curve curve = points_of(shown, is_inset ? "" : all_series()[b].title, all_series()[b].ink);
    curve.shape = all_series()[b].shape;
    panel.curves.push_back(curve);
  }
  // our line and the paper's, over the range of the points
  const Drawn range{is_log ? sorted.front() : 0.0, high, is_log};
  const auto line = [&](double prefactor, const std::string& title, Ink ink) {
    panel.curves.push_back(
        curve_of([=](double x) { return prefactor * x; }, range, is_inset ? "" : title, ink));
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

}  // namespace

PaperSection fig11_section(PaperData& data) {
  PaperSection section{.text = {page::words("fig11.intro")}};
  page::Table table = page::words_table("fig11.table");
  std::vector<VariedCurve> parts;
  double by_grain = not_known;
  for (const Series& branch : all_series()) {
    const std::vector<VariedValue> values = read_values(data, branch.varied, section);
    if (branch.varied == Varied::frequency) by_grain = prefactor_by_grain(values);
    const VariedCurve& points = parts.emplace_back(points_on_eq3(values));
    const Proportion line = fit_proportion(points.x, points.y);
    const PowerFit power = fit_power(points.x, points.y);
    table.rows.push_back({branch.name, std::to_string(line.samples), page::number(line.factor),
                          page::interval(line.low, line.high), page::number(line.spread),
                          words_of(power), words_of(misfit_of(power, points))});
  }
  // all series as one: a law without a free exponent, and one with
  const VariedCurve all = together(parts);
  if (all.x.empty()) return section;
  const Proportion line = fit_proportion(all.x, all.y);
  const PowerFit power = fit_power(all.x, all.y);
  const Misfit misfit = misfit_of(power, all);
  const double linear = linear_prefactor(all);
  const page::Values words{{"C", page::number(line.factor)},
                           {"interval", page::interval(line.low, line.high)},
                           {"spread", page::number(line.spread)},
                           {"exponent", words_of(power)},
                           {"misfit", words_of(misfit)},
                           {"meaning", page::words("misfit")},
                           {"grain", page::number(by_grain)},
                           {"linear", page::number(linear)},
                           {"without", page::number(linear_prefactor(without_largest(all)))}};
  section.draw("fig11",
               {.height = 900,
                .panels = {eq3_panel(parts, all, line.factor, View::logarithmic),
                           eq3_panel(parts, all, line.factor, View::linear),
                           eq3_panel(parts, all, line.factor, View::origin)}},
               words);
  section.tables = {table};
  section.claim("fig11.line", words, PaperRange::exponent(1.0), found(power, misfit.p));
  section.claim("fig11.factor", words, PaperRange::roughly(paper::prefactor),
                {.value = line.factor, .low = line.low, .high = line.high});
  section.report("fig11.linear", words);
  return section;
}

}  // namespace ballast
