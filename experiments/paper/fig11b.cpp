// Fig. 11b, beyond the paper: C of Eq. 3 along its right side X. All that is varied falls on one
// smooth curve, which is not a line.

#include <algorithm>
#include <cmath>

#include "experiments/paper/one_curve.hpp"

namespace ballast {
namespace {

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

Panel panel_along_x(const char* y_label) {
  return {.x_label = "right side of Eq. 3 without {/:Italic C},  {/:Italic X}  (mm)",
          .y_label = y_label,
          .log_x = true};
}

Panel prefactor_panel(const OneCurve& all) {
  Panel panel = panel_along_x("{/:Italic C} = Δ{/:Italic x}_{max} / {/:Italic X}");
  panel.y_min = 0.0;
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
    VariedCurve points;
    for (const CurvePoint& point : all.points) {
      if (point.series != series) continue;
      const SampleMean factor = prefactor_of(point.value);
      points.x.push_back(to_mm * point.x);
      points.y.push_back(factor.mean);
      points.error.push_back(factor.error);
    }
    if (points.x.empty()) continue;
    panel.curves.push_back(points_of(points, all_series()[series].title, all_series()[series].ink));
    panel.curves.back().shape = all_series()[series].shape;
  }
  panel.lines = {{paper::prefactor, "the paper’s 0.01", false, Ink::grey}};
  return panel;
}

/// A series's exponent as one of X: X goes with nu^-2, f_max^-1, g^2, m/(m + m_w).
double in_x(const SeriesExponent& seen) { return 1.0 / all_series()[seen.series].exponent; }

Panel slope_panel(const OneCurve& all) {
  Panel panel = panel_along_x("d ln Δ{/:Italic x}_{max} / d ln {/:Italic X}");
  panel.lines = {{1.0, "Eq. 3: 1", false, Ink::vermilion}};
  const auto slope = [&](double x) { return all.curve.fit.at(all.curve.slope_row(x)); };
  const auto half = [&](double x) { return half_width(all, all.curve.slope_row(x)); };
  if (all.between.degrees_of_freedom > 0)
    panel.curves.push_back(band(
        all, [&](double x) { return slope(x) - half(x); },
        [&](double x) { return slope(x) + half(x); }));
  panel.curves.push_back(along(all, slope, "the curve’s", Ink::black));
  for (const SeriesExponent& seen : all.exponents) {
    double logs = 0.0;
    int count = 0;
    for (const CurvePoint& point : all.points)
      if (point.series == seen.series) {
        logs += std::log(point.x);
        ++count;
      }
    if (count == 0) continue;
    panel.curves.push_back(points_of({{to_mm * std::exp(logs / count)},
                                      {seen.own * in_x(seen)},
                                      {std::abs(seen.own_error * in_x(seen))}},
                                     std::string(all_series()[seen.series].title) + ", own",
                                     all_series()[seen.series].ink));
    panel.curves.back().shape = all_series()[seen.series].shape;
    panel.curves.back().width = 3.2;
  }
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

page::Table exponents_table(const OneCurve& all) {
  page::Table table = page::words_table("curve.exponents");
  std::vector<double> chances;
  for (const SeriesExponent& seen : all.exponents)
    chances.push_back(seen.is_inside ? seen.p : not_known);
  const std::vector<double> corrected = holm(chances);
  for (size_t k = 0; k < all.exponents.size(); ++k) {
    const SeriesExponent& seen = all.exponents[k];
    table.rows.push_back({all_series()[seen.series].name, std::to_string(seen.points),
                          page::with_error(seen.own, seen.own_error),
                          page::with_error(seen.predicted, seen.predicted_error),
                          page::number(all_series()[seen.series].exponent, 1),
                          seen.is_inside
                              ? words_of_p(seen.p) + " (" + words_of_p(corrected[k]) + ")"
                              : page::Text("extrapolated")});
  }
  return table;
}

/// What the grains push with, as measured, and the C that it means: beside the C that is seen. A
/// row to each point, along X.
page::Table forces_table(PaperData& data, const OneCurve& all, page::Values& words) {
  page::Table table = page::words_table("curve.forces");
  std::vector<const CurvePoint*> along;
  for (const CurvePoint& point : all.points) along.push_back(&point);
  std::sort(along.begin(), along.end(),
            [](const CurvePoint* a, const CurvePoint* b) { return a->x < b->x; });
  std::vector<double> said, seen;
  for (const CurvePoint* point : along) {
    std::vector<double> push, carried, theory;
    for (const size_t run : point->value.runs)
      if (const RunObservables* o = data.observables_of(run)) {
        const RunFacts& facts = o->seen.facts;
        push.push_back(o->law.push / (facts.grain_mass * facts.gravity));
        carried.push_back(o->law.carried_mass / facts.grain_mass);
        theory.push_back(o->law.prefactor);
      }
    said.push_back(sample_mean(theory).mean);
    seen.push_back(prefactor_of(point->value).mean);
    table.rows.push_back(
        {all_series()[point->series].name, point->value.label, page::number(to_mm * point->x),
         words_of(sample_mean(push)), words_of(sample_mean(carried)), words_of(sample_mean(theory)),
         words_of(prefactor_of(point->value)), page::number(said.back() / seen.back(), 2)});
  }
  const Proportion ratio = fit_proportion(seen, said);
  words.emplace("ratio",
                page::number(ratio.factor, 2) + " " + page::interval(ratio.low, ratio.high));
  words.emplace("follows", words_of(fit_power(said, seen)));
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
      {"curvature", words_of(all.curvature)},
      {"curvature_p",
       words_of_p(student_p(all.curvature.mean / all.curvature.error, all.curvature.samples - 1))},
      {"samples", std::to_string(all.curvature.samples)},
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

PaperSection curve_section(PaperData& data) {
  PaperSection section{.text = {page::words("curve.intro")}};
  std::vector<std::vector<VariedValue>> values;
  for (const Series& series : all_series())
    values.push_back(read_values(data, series.varied, section));
  const OneCurve all = one_curve(values);
  if (!all.is_known()) return section;
  page::Values words = words_for(all);
  const page::Table forces = forces_table(data, all, words);
  section.draw("fig11b", {.height = 860, .panels = {prefactor_panel(all), slope_panel(all)}},
               words);
  section.text.push_back(page::words("curve.theory", words));
  section.tables = {along_table(all), forces, exponents_table(all)};
  const double half = student_t95(all.between.degrees_of_freedom) * all.offset_error;
  section.claim("curve.grouping", words, PaperRange::about(0.0, 0.1),
                {.value = all.largest_offset,
                 .low = all.largest_offset - half,
                 .high = all.largest_offset + half,
                 .law_p = all.curve_misfit.p});
  section.report("curve.shape", words);
  section.report("curve.bend", words);
  section.report("curve.push", words);
  return section;
}

}  // namespace ballast
