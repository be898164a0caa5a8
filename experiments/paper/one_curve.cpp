#include "experiments/paper/one_curve.hpp"

#include <algorithm>
#include <numbers>

namespace ballast {
namespace {

/// Settings so near to one another are the same: the base run of all series is known again.
bool are_same(const RunFacts& a, const RunFacts& b) {
  const auto is_near = [](double x, double y) { return std::abs(x - y) <= 1e-6 * std::abs(x); };
  return is_near(a.frequency, b.frequency) && is_near(a.gravity, b.gravity) &&
         is_near(a.f_max / a.grain_mass, b.f_max / b.grain_mass) &&
         is_near(a.wall_mass / a.grain_mass, b.wall_mass / b.grain_mass);
}

std::vector<CurvePoint> distinct_points(const std::vector<Groups>& groups) {
  std::vector<CurvePoint> points;
  for (size_t series = 0; series < groups.size(); ++series)
    for (const Group& group : groups[series]) {
      const CurvePoint point{series, group, eq3_of(group.first())};
      const bool is_new = std::ranges::none_of(points, [&](const CurvePoint& other) {
        return are_same(other.group.first().facts, group.first().facts);
      });
      if (is_new && point.x > 0.0 && std::isfinite(point.log_rise())) points.push_back(point);
    }
  return points;
}

/// Least squares of the points' ln Delta x_max; `offsets`: a factor for each series but the first.
WeightedFit fit_points(const std::vector<CurvePoint>& points, const LogPolynomial& shape,
                       int values, double deviation, bool offsets) {
  const auto count = static_cast<Eigen::Index>(points.size());
  std::vector<size_t> present;
  for (const CurvePoint& point : points)
    if (std::find(present.begin(), present.end(), point.series) == present.end())
      present.push_back(point.series);
  const auto extra = static_cast<Eigen::Index>(offsets ? present.size() - 1 : 0);
  Eigen::MatrixXd design = Eigen::MatrixXd::Zero(count, values + extra);
  Eigen::VectorXd y(count), error(count);
  for (Eigen::Index k = 0; k < count; ++k) {
    const CurvePoint& point = points[static_cast<size_t>(k)];
    const double u = std::log(point.x / shape.middle);
    for (int power = 0; power < values; ++power) design(k, power) = std::pow(u, power);
    for (Eigen::Index s = 0; s < extra; ++s)
      design(k, values + s) = point.series == present[static_cast<size_t>(s) + 1] ? 1.0 : 0.0;
    y[k] = point.log_rise();
    error[k] = deviation / std::sqrt(static_cast<double>(point.group.samples.size()));
  }
  return fit_weighted(design, y, error);
}

LogPolynomial polynomial(const std::vector<CurvePoint>& points, int values, double deviation) {
  LogPolynomial result;
  double logs = 0.0;
  for (const CurvePoint& point : points)
    logs += std::log(point.x) / static_cast<double>(points.size());
  result.middle = std::exp(logs);
  result.fit = fit_points(points, result, values, deviation, false);
  return result;
}

Misfit misfit_of(const WeightedFit& fit, const PooledError& error) {
  if (error.degrees_of_freedom < 1) return {};
  return {fit.reduced(), f_p(fit.reduced(), fit.degrees_of_freedom, error.degrees_of_freedom)};
}

void add_offsets(double deviation, OneCurve& all) {
  const WeightedFit shifted = fit_points(all.points, all.curve, 3, deviation, true);
  all.offsets = improvement(all.curve.fit, shifted);
  for (Eigen::Index k = 3; k < shifted.value.size(); ++k)
    if (!(std::abs(shifted.value[k]) <= std::abs(all.largest_offset))) {
      all.largest_offset = shifted.value[k];
      all.offset_error = std::sqrt(shifted.covariance(k, k));
    }
}

constexpr double to_mm = 1e3;

/// Half width of the 95 % interval of a combination of the curve's values: the errors are the
/// pooled ones.
double half_width(const OneCurve& all, const Eigen::VectorXd& row) {
  return student_t95(all.between.degrees_of_freedom) * all.curve.fit.error_at(row);
}

std::pair<double, double> reach_of(const OneCurve& all) {
  double low = 1e300, high = 0.0;
  for (const CurvePoint& point : all.points) {
    low = std::min(low, point.x);
    high = std::max(high, point.x);
  }
  return {low, high};
}

/// An area between two functions of X [m], drawn over X in mm.
template <class Low, class High>
Curve band(const OneCurve& all, const Low& low, const High& high) {
  const auto [least, most] = reach_of(all);
  const Drawn range{least, most, true};
  Curve area = curve_of(high, range, "95 %", Ink::light, false);
  area.y_low = curve_of(low, range, "", Ink::light, false).y;
  area.mark = Mark::area;
  area.opacity = 0.5;
  for (double& x : area.x) x *= to_mm;
  return area;
}

template <class Function>
Curve along(const OneCurve& all, const Function& function, const std::string& title, Ink ink,
            bool dashed = false) {
  const auto [least, most] = reach_of(all);
  Curve curve = curve_of(function, {least, most, true}, title, ink, dashed);
  for (double& x : curve.x) x *= to_mm;
  return curve;
}

Panel prefactor_panel(const OneCurve& all) {
  Panel panel{.x_label = "right side of Eq. 3 without {/:Italic C},  {/:Italic X}  (mm)",
              .y_label = "{/:Italic C} = Δ{/:Italic x}_{max} / {/:Italic X}",
              .log_x = true,
              .y_min = 0.0};
  const auto bound = [&](double x, double sign) {
    return all.curve.at(x) / x * std::exp(sign * half_width(all, all.curve.row(x)));
  };
  if (all.between.degrees_of_freedom > 0)
    panel.curves.push_back(band(
        all, [&](double x) { return bound(x, -1.0); }, [&](double x) { return bound(x, 1.0); }));
  panel.curves.push_back(along(
      all, [&](double x) { return all.curve.at(x) / x; }, "quadratic in ln X", Ink::black));
  panel.curves.push_back(along(
      all, [&](double x) { return all.line.at(x) / x; }, "straight line", Ink::grey, true));
  for (size_t series = 0; series < all_series().size(); ++series) {
    Points points;
    for (const CurvePoint& point : all.points)
      if (point.series == series) points.add(to_mm * point.x, point.group.mean(prefactor_of));
    if (!points.x.empty())
      panel.curves.push_back(curve_of(points, all_series()[series].title, all_series()[series].ink,
                                      all_series()[series].shape));
  }
  panel.lines = {{paper::prefactor, "the paper’s 0.01", false, Ink::grey}};
  return panel;
}

/// C, the local exponent and the force that they mean, along X.
page::Table along_table(const OneCurve& all) {
  page::Table table = page::words_table("curve.along");
  const auto [least, most] = reach_of(all);
  std::vector<double> places{least};
  for (const double mm : {1.0, 3.0, 10.0, 30.0, 100.0, 300.0, 1000.0})
    if (1e-3 * mm > 1.2 * least && 1e-3 * mm < most / 1.2) places.push_back(1e-3 * mm);
  places.push_back(most);
  for (const double x : places) {
    const double c = all.curve.at(x) / x, half = half_width(all, all.curve.row(x)),
                 slope = all.curve.fit.at(all.curve.slope_row(x)),
                 slope_half = half_width(all, all.curve.slope_row(x));
    table.rows.push_back(
        {page::number(to_mm * x), page::number(to_mm * x * c),
         page::number(c) + " " + page::interval(c * std::exp(-half), c * std::exp(half)),
         page::number(slope) + " " + page::interval(slope - slope_half, slope + slope_half),
         page::number(force_of_prefactor(c))});
  }
  return table;
}

page::Text percent_words(double deviation) { return page::number(100.0 * deviation, 2) + " %"; }

page::Values words_for(const OneCurve& all) {
  const auto [least, most] = reach_of(all);
  const double c_small = all.curve.at(least) / least, c_large = all.curve.at(most) / most;
  return {
      {"points", std::to_string(all.points.size())},
      {"curve", words_of(all.curve_misfit)},
      {"line", words_of(all.line_misfit)},
      {"paired", words_of(all.paired_misfit)},
      {"between_error", percent_words(all.between.deviation)},
      {"between_freedom", std::to_string(all.between.degrees_of_freedom)},
      {"paired_error", percent_words(all.paired.deviation)},
      {"bend", "F " + page::number(all.bend.ratio, 2) + ", p " + words_of_p(all.bend.p)},
      {"third", "F " + page::number(all.third.ratio, 2) + ", p " + words_of_p(all.third.p)},
      {"offsets", "F " + page::number(all.offsets.ratio, 2) + ", p " + words_of_p(all.offsets.p)},
      {"offset", percent_words(all.largest_offset)},
      {"least", page::number(to_mm * least)},
      {"most", page::number(to_mm * most)},
      {"c_small", page::number(c_small)},
      {"c_large", page::number(c_large)},
      {"n_small", page::number(all.curve.fit.at(all.curve.slope_row(least)))},
      {"n_large", page::number(all.curve.fit.at(all.curve.slope_row(most)))},
      {"f_small", page::number(force_of_prefactor(c_small), 2)},
      {"f_large", page::number(force_of_prefactor(c_large), 2)}};
}

}  // namespace

std::span<const Series> all_series() {
  using Run = const RunSummary&;
  using Row = const RunRow&;
  // Rows of 23 November 2026 and before have g and m_w in one stage.
  static const std::vector<Series> all{
      {{"ν", {"frequency", "slowest"}}, frequency_of, "ν", Ink::blue, MarkShape::triangle, -2.0},
      {{"f_max", {"force"}}, force_of, "f_{max}", Ink::vermilion, MarkShape::circle, -1.0},
      {{"g",
        {"gravity", "gravity-mass"},
        [](Row r) { return r.stage == "gravity" || r.run.facts.gravity != 9.81; }},
       [](Run run) { return run.facts.gravity; },
       "g",
       Ink::green,
       MarkShape::square,
       2.0},
      {{"m_w",
        {"mass", "gravity-mass"},
        [](Row r) { return r.stage == "mass" || r.run.facts.gravity == 9.81; }},
       [](Run run) { return run.facts.grain_mass / (run.facts.grain_mass + run.facts.wall_mass); },
       "m_w",
       Ink::purple,
       MarkShape::diamond,
       1.0}};
  return all;
}

Eigen::VectorXd LogPolynomial::row(double x) const {
  Eigen::VectorXd powers(fit.value.size() ? fit.value.size() : 3);
  for (Eigen::Index k = 0; k < powers.size(); ++k)
    powers[k] = std::pow(std::log(x / middle), static_cast<double>(k));
  return powers;
}

Eigen::VectorXd LogPolynomial::slope_row(double x) const {
  Eigen::VectorXd slope = Eigen::VectorXd::Zero(fit.value.size());
  for (Eigen::Index k = 1; k < slope.size(); ++k)
    slope[k] = static_cast<double>(k) * std::pow(std::log(x / middle), static_cast<double>(k - 1));
  return slope;
}

double LogPolynomial::at(double x) const { return std::exp(fit.at(row(x))); }

OneCurve one_curve(const std::vector<Groups>& groups) {
  OneCurve all;
  all.points = distinct_points(groups);
  Groups distinct;
  for (const CurvePoint& point : all.points) distinct.push_back(point.group);
  all.between = scatter_between(distinct, rise_of);
  all.paired = scatter_paired(distinct, rise_of);
  if (!all.is_known()) return all;
  // with one sample of each point no errors are known: then every point weighs the same
  const double deviation = all.between.degrees_of_freedom > 0 ? all.between.deviation : 1.0;
  all.line = polynomial(all.points, 2, deviation);
  all.curve = polynomial(all.points, 3, deviation);
  all.line_misfit = misfit_of(all.line.fit, all.between);
  all.curve_misfit = misfit_of(all.curve.fit, all.between);
  if (all.paired.degrees_of_freedom > 0)
    all.paired_misfit = misfit_of(polynomial(all.points, 3, all.paired.deviation).fit, all.paired);
  all.bend = improvement(all.line.fit, all.curve.fit);
  all.third = improvement(all.curve.fit, polynomial(all.points, 4, deviation).fit);
  add_offsets(deviation, all);
  return all;
}

double force_of_prefactor(double prefactor) {
  return 2.0 / 3.0 * std::numbers::pi * std::sqrt(prefactor);
}

void fill_curve(PaperData& data, PaperSection& section) {
  std::vector<Groups> groups;
  for (const Series& series : all_series())
    groups.push_back(data.groups(series.selection, series.along));
  const OneCurve all = one_curve(groups);
  if (!all.is_known()) return;
  const page::Values words = words_for(all);
  section.draw("fig11b", {.height = 480, .panels = {prefactor_panel(all)}}, words);
  section.text.push_back(page::words("curve.theory", words));
  section.add(along_table(all));
  const double half = student_t95(all.between.degrees_of_freedom) * all.offset_error;
  section.claim("curve.grouping", words, PaperRange::about(0.0, 0.1),
                {.value = all.largest_offset,
                 .low = all.largest_offset - half,
                 .high = all.largest_offset + half,
                 .law_p = all.curve_misfit.p});
  section.report("curve.shape", words);
  section.report("curve.bend", words);
}

}  // namespace ballast
