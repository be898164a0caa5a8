#include "experiments/paper/laws.hpp"

#include <algorithm>
#include <array>
#include <set>

namespace ballast {
namespace {

/// A series of runs: points of one colour and mark, and a row of a table.
struct Series {
  const char* name;
  Selection rows;
  Ink ink;
  MarkShape shape = MarkShape::circle;
  RunMeasure along = "";        ///< the varied quantity
  const char* title = nullptr;  ///< in the legend, in the notation of page::marked()
};
/// The variables of Eq. 3: nu [Hz], f_max/(m g), g [m/s^2], m/(m + m_w), as in the paper's Fig. 11.
const std::vector<Series> all_series{
    {"ν", "frequency; slowest", Ink::blue, MarkShape::triangle, "frequency", "ν"},
    {"f_max", "force", Ink::vermilion, MarkShape::circle, "force_over_weight", "f~max~"},
    {"g", "gravity", Ink::green, MarkShape::square, "gravity", "g"},
    {"m_w", "mass", Ink::purple, MarkShape::diamond, "grain_share", "m~w~"}};
/// The lightest wall, in the same box, compared with the curve of the others.
const Series light_wall{.name = "light wall",
                        .rows = "mass wall_mass_over_grains<0.2; loads largest_size>0.04",
                        .ink = Ink::black,
                        .shape = MarkShape::triangle,
                        .title = "m~w~  = m/10"};

/// Settings so near to one another are the same: this recognises the base run of all series.
bool are_same(const RunRow& a, const RunRow& b) {
  return std::ranges::all_of(
      std::array{"frequency", "gravity", "force_over_weight", "wall_mass_over_grains"},
      [&](const char* name) { return std::abs(a[name] - b[name]) <= 1e-6 * std::abs(a[name]); });
}

std::vector<CurvePoint> distinct_points(const std::vector<Groups>& groups) {
  std::vector<CurvePoint> points;
  for (size_t series = 0; series < groups.size(); ++series)
    for (const Group& group : groups[series]) {
      const CurvePoint point{series, group, (*group.samples.front())["eq3"]};
      const bool is_new = std::ranges::none_of(points, [&](const CurvePoint& other) {
        return are_same(*other.group.samples.front(), *group.samples.front());
      });
      if (is_new && point.x > 0.0 && std::isfinite(point.log_rise())) points.push_back(point);
    }
  return points;
}

/// Least-squares fit of ln Delta x_max; `offsets` adds a factor for each series but the first.
WeightedFit fit_points(const std::vector<CurvePoint>& points, const LogPolynomial& shape,
                       int values, double deviation, bool offsets) {
  std::vector<size_t> present;  // points come series by series
  for (const CurvePoint& point : points)
    if (present.empty() || present.back() != point.series) present.push_back(point.series);
  const size_t extra = offsets ? present.size() - 1 : 0;
  Eigen::MatrixXd design = Eigen::MatrixXd::Zero(points.size(), values + extra);
  Eigen::VectorXd y(points.size()), error(points.size());
  for (size_t k = 0; k < points.size(); ++k) {
    const CurvePoint& point = points[k];
    const double u = std::log(point.x / shape.middle);
    for (int power = 0; power < values; ++power) design(k, power) = std::pow(u, power);
    for (size_t s = 0; s < extra; ++s) design(k, values + s) = point.series == present[s + 1];
    y[k] = point.log_rise();
    error[k] = deviation / std::sqrt(static_cast<double>(point.group.samples.size()));
  }
  return fit_weighted(design, y, error);
}

LogPolynomial polynomial(const std::vector<CurvePoint>& points, int values, double deviation) {
  LogPolynomial result;
  double logs = 0.0;
  for (const CurvePoint& point : points) logs += std::log(point.x) / points.size();
  result.middle = std::exp(logs);
  result.fit = fit_points(points, result, values, deviation, false);
  return result;
}

constexpr double to_mm = 1e3;

/// Half width of the 95 % interval of a linear combination (`row`) of the curve's coefficients,
/// with the pooled errors.
double half_width(const MasterCurve& all, const Eigen::VectorXd& row) {
  return student_t95(all.between.degrees_of_freedom) * all.curve.fit.error_at(row);
}

/// A function of X [m], drawn over X in mm.
template <class Function>
Curve along(const MasterCurve& all, const Function& function, const page::Text& title, Ink ink,
            bool dashed = false) {
  Curve curve = curve_of(function, {all.least, all.most, true}, title, ink, dashed);
  for (double& x : curve.x) x *= to_mm;
  return curve;
}

/// Means of C along X; their bars are the errors that the fit gives them.
Curve curve_of(const MasterCurve& all, const std::vector<CurvePoint>& shown, const Series& series) {
  Points points;
  for (const CurvePoint& point : shown) {
    SampleMean mean = point.group.mean("prefactor");
    mean.error = mean.mean * all.between.deviation / std::sqrt(1.0 * mean.samples);
    points.add(to_mm * point.x, mean);
  }
  return curve_of(points, page::marked(series.title), series.ink, series.shape);
}

/// The panel of C along X. `small_loads` and `light` are points that the curve was not fitted to.
Panel prefactor_panel(const MasterCurve& all, const std::vector<CurvePoint>& small_loads,
                      const std::vector<CurvePoint>& light) {
  Panel panel{.x_label = page::marked("right side of Eq. 3 without *C*,  *X*  (mm)"),
              .y_label = page::marked("*C* = Δ*x*~max~ / *X*"),
              .log_x = true,
              .y_min = 0.0};
  const auto bound = [&](double sign) {
    const auto c = [&](double x) {
      return all.curve.at(x) / x * std::exp(sign * half_width(all, all.curve.row(x)));
    };
    return along(all, c, "95 %", Ink::light);
  };
  if (all.between.degrees_of_freedom > 0) {
    Curve& band = panel.curves.emplace_back(bound(1.0));
    band.y_low = bound(-1.0).y;
    band.mark = Mark::area;
    band.opacity = 0.5;
  }
  panel.curves.push_back(along(
      all, [&](double x) { return all.curve.at(x) / x; }, "quadratic in ln X", Ink::black));
  panel.curves.push_back(along(
      all, [&](double x) { return all.line.at(x) / x; }, "power law", Ink::grey, true));
  const auto add = [&](const std::vector<CurvePoint>& points, const Series& series) {
    if (!points.empty()) panel.curves.push_back(curve_of(all, points, series));
  };
  for (size_t k = 0; k < all_series.size(); ++k) {
    std::vector<CurvePoint> points = all.points;
    std::erase_if(points, [&](const CurvePoint& point) { return point.series != k; });
    add(points, all_series[k]);
  }
  add(small_loads,
      {.name = "small loads", .rows = "", .ink = Ink::grey, .title = "f~max~  < 2 m g"});
  add(light, light_wall);
  panel.curves.push_back(along(
      all, [](double) { return paper::prefactor; }, "the paper’s 0.01", Ink::vermilion));
  return panel;
}

/// The table of C and the local exponent along X.
page::Table along_table(const MasterCurve& all) {
  page::Table table = page::words_table("curve.along");
  std::vector<double> places{all.least};
  for (const double mm : {1.0, 3.0, 10.0, 30.0, 100.0, 300.0, 1000.0})
    if (1e-3 * mm > 1.2 * all.least && 1e-3 * mm < all.most / 1.2) places.push_back(1e-3 * mm);
  places.push_back(all.most);
  for (const double x : places) {
    const double c = all.curve.at(x) / x, half = half_width(all, all.curve.row(x)),
                 slope = all.curve.fit.at(all.curve.slope_row(x)),
                 slope_half = half_width(all, all.curve.slope_row(x));
    table.rows.push_back(
        {page::number(to_mm * x), page::number(to_mm * x * c),
         page::number(c) + " " + page::interval(c * std::exp(-half), c * std::exp(half)),
         page::number(slope) + " " + page::interval(slope - slope_half, slope + slope_half)});
  }
  return table;
}

page::Text percent_words(double deviation) { return page::number(100.0 * deviation, 2) + " %"; }

page::Values words_for(const MasterCurve& all) {
  const auto [small, large] = std::ranges::minmax(all.points, {}, &CurvePoint::x);
  const auto mean = [](const CurvePoint& point, RunMeasure measure) {
    return page::number(point.group.mean(measure).mean, 2);
  };
  return {{"points", std::to_string(all.points.size())},
          {"curve", words_of(all.curve_misfit)},
          {"line", words_of(all.line_misfit)},
          {"paired", words_of(all.paired_misfit)},
          {"between_error", percent_words(all.between.deviation)},
          {"between_freedom", std::to_string(all.between.degrees_of_freedom)},
          {"paired_error", percent_words(all.paired.deviation)},
          {"bend", words_of(all.bend, "F")},
          {"third", words_of(all.third, "F")},
          {"offsets", words_of(all.offsets, "F")},
          {"offset", percent_words(all.largest_offset)},
          {"least", page::number(to_mm * all.least)},
          {"most", page::number(to_mm * all.most)},
          {"c_small", page::number(all.curve.at(all.least) / all.least)},
          {"c_large", page::number(all.curve.at(all.most) / all.most)},
          {"n_small", page::number(all.curve.fit.at(all.curve.slope_row(all.least)))},
          {"n_large", page::number(all.curve.fit.at(all.curve.slope_row(all.most)))},
          {"f_small", mean(small, "push_over_weight")},
          {"f_large", mean(large, "push_over_weight")},
          {"carried_small", mean(small, "carried_share")},
          {"carried_large", mean(large, "carried_share")}};
}

// Power laws and lines through the origin: Figs. 9, 10 and 11, C against its theory and against the
// shape of the box. A figure is a row of all_laws() and its words.

/// One figure: measured means against a law y ~ x^exponent.
struct Law {
  const char *section, *name;  ///< its words are <name>.title, .paper, .found, .claim
  std::vector<Series> families;
  LabelledMeasure x, y;
  double exponent;               ///< of the paper, or of the theory
  double split = not_known;      ///< two more exponents up to here and from here on; NaN: none
  double reference = not_known;  ///< y = reference x is drawn too
  /// Returns whether the law is judged against the paper; else it is a finding.
  bool is_of_paper() const { return std::string_view(section).starts_with("fig"); }
};

/// All laws: Figs. 9 to 11, the premise of Eq. 5, then C along the shape of the box, and against
/// its theory.
std::vector<Law> all_laws() {
  using enum MarkShape;
  const LabelledMeasure rise{"rise", "Δ*x*~max~  (mm)", 1e3},
      prefactor{"prefactor", "*C* = Δ*x*~max~ / *X*", 1.0},
      frequency{"frequency", "*ν*  (Hz)", 1.0}, speed{"speed_in", "*v*~max~  (mm/s)", 1e3},
      gain{"gain", "Δ*ρ*~1~  (10^−4^)", 1e4}, force{"force_over_weight", "*f*~max~ / (*m g*)", 1.0},
      gravity{"gravity", "*g*  (m/s^2^)", 1.0}, mass{"grain_share", "*m* / (*m* + *m*~w~)", 1.0},
      eq3{"eq3", "right side of Eq. 3 without *C*  (mm)", 1e3}, aspect{"aspect", "*L*/*H*", 1.0},
      ratio{"theory_ratio", "*C* / *C*~theory~", 1.0};
  const Series slow{"5 Hz", "box frequency=5", Ink::blue},
      fast{"20 Hz", "box frequency=20", Ink::vermilion},
      beyond{"ν ≥ 10 Hz", "frequency frequency>9", Ink::blue, triangle, "frequency"};
  // a run that is in several families is a point of the first
  std::vector<Series> everything = all_series;
  everything.insert(everything.end(),
                    {{"L/H", "box", Ink::orange},
                     {"large loads", "loads", Ink::black, triangle},
                     {"deposit", "deposits", Ink::grey, square},
                     {"grains, size", "shapes; sizes; reading", Ink::sky, diamond}});
  return {{"fig9", "fig9", {all_series[0]}, frequency, rise, -2.0, 10.0},
          {"fig9", "fig9_speed", {all_series[0]}, frequency, speed, -1.0, 10.0},
          {"fig10", "fig10", {all_series[1]}, force, rise, -1.0, 3.0},
          {"fig10", "fig10_gravity", {all_series[2]}, gravity, rise, 2.0, 5.0},
          {"fig10", "fig10_mass", {all_series[3]}, mass, rise, 1.0, 0.6},
          {"fig11", "fig11", all_series, eq3, rise, 1.0, 10.0, paper::prefactor},
          {"fig13", "fig13_premise", {beyond}, rise, gain, 1.0},
          {"box", "box_slow", {slow}, aspect, prefactor, -1.0, 1.5},
          {"box", "box_fast", {fast}, aspect, prefactor, -1.0, 1.5},
          {"theory", "theory", everything, eq3, ratio, 0.0}};
}

/// The power law fitted to the points between `low` and `high`: a law that bends has two exponents.
PowerFit fit_part(const Points& points, double low, double high) {
  Points part;
  for (size_t k = 0; k < points.x.size(); ++k)
    if (points.x[k] >= low && points.x[k] <= high) part.add(points.x[k], {points.y[k]});
  return fit_power(part.x, part.y);
}

/// The factor y over x; where a constant is expected, y itself.
Proportion proportion(const Law& law, const Points& points) {
  const std::vector<double> ones(points.x.size(), 1.0);
  return fit_proportion(law.exponent == 0.0 ? ones : points.x, points.y);
}

/// Adds lines to the panel of the measured points: the fitted power law, and either the expected
/// exponent through the fit in the middle of the points, or the theory, or a line of reference.
void draw_lines(const Law& law, const Points& all, const PowerFit& fit, Panel& panel) {
  const auto [low, high] = std::ranges::minmax_element(all.x);
  const Drawn range{*low, *high, true};
  double logs = 0.0;
  for (const double x : all.x) logs += std::log(x) / static_cast<double>(all.x.size());
  const double middle = std::exp(logs);
  panel.curves.push_back(curve_of([&](double x) { return fit.at(x); }, range,
                                  "fit, exponent " + page::number(fit.exponent), Ink::black));
  if (law.exponent == 0.0)
    panel.lines = {{1.0, "the theory", false, Ink::grey}};
  else if (std::isnan(law.reference))
    panel.curves.push_back(curve_of(
        [&](double x) { return fit.at(middle) * std::pow(x / middle, law.exponent); }, range,
        (law.is_of_paper() ? "the paper’s exponent " : "exponent ") + page::number(law.exponent, 1),
        Ink::vermilion, false));
  else
    panel.curves.push_back(curve_of([&](double x) { return law.reference * x; }, range,
                                    "the paper’s C = 0.01", Ink::grey));
}

void add_law(PaperData& data, const Law& law, page::Table& table, PaperSection& section) {
  Panel panel{.x_label = page::marked(law.x.label),
              .y_label = page::marked(law.y.label),
              .log_x = true,
              .log_y = true};
  std::set<std::string> seen;  // equal records of several stages and families are one point
  Groups drawn;
  for (const Series& family : law.families) {
    Groups distinct;
    for (Group& group : data.settings(family.rows))
      if (law.is_of_paper() || seen.insert(group.samples.front()->record).second)
        distinct.push_back(std::move(group));
    std::ranges::sort(distinct, {}, [&](const Group& group) {
      const double x = group.mean(law.x.measure).mean;
      return x > 0.0 ? x : 0.0;  // NaN, where it is not known, has no order
    });
    const Points points =
        points_of(distinct, law.x.measure, law.y.measure, law.x.factor, law.y.factor);
    if (points.x.empty()) continue;
    for (const Group& group : distinct)
      if (!law.is_of_paper() || seen.insert(group.samples.front()->record).second)
        drawn.push_back(group);
    panel.curves.push_back(curve_of(points, page::marked(family.title ? family.title : family.name),
                                    family.ink, family.shape));
    const PowerFit fit = fit_power(points.x, points.y);
    table.rows.push_back(
        {page::words(law.name + std::string(".title")), family.name,
         std::to_string(points.x.size()), words_of(fit), words_of(misfit_of(points)),
         law.exponent == 0.0 || law.exponent == 1.0 ? words_of(proportion(law, points))
                                                    : page::Text("–")});
  }
  const Points all = points_of(drawn, law.x.measure, law.y.measure, law.x.factor, law.y.factor);
  const PowerFit fit = fit_power(all.x, all.y);
  if (!std::isfinite(fit.exponent)) return;
  const VarianceRatio misfit = misfit_of(all);
  const Proportion ratio = proportion(law, all);
  const auto [low, high] = std::ranges::minmax(all.x);
  const Points push = points_of(drawn, law.x.measure, "push_over_weight");
  const page::Values words{{"points", std::to_string(all.x.size())},
                           {"exponent", words_of(fit)},
                           {"misfit", words_of(misfit)},
                           {"low", words_of(fit_part(all, 0.0, law.split))},
                           {"high", words_of(fit_part(all, law.split, 1e9))},
                           {"ratio", words_of(ratio)},
                           {"spread", page::number(ratio.spread)},
                           {"least", page::number(*std::ranges::min_element(all.y))},
                           {"most", page::number(*std::ranges::max_element(all.y))},
                           {"at_low", page::number(fit.at(low), 2)},
                           {"at_high", page::number(fit.at(high), 2)},
                           {"push", words_of(fit_power(push.x, push.y))}};
  draw_lines(law, all, fit, panel);
  section.draw(law.name, {.height = 480, .panels = {panel}}, words);
  const std::string claim = law.name + std::string(".claim");
  if (!law.is_of_paper()) return section.report(claim, words);
  section.claim(claim, words, PaperRange::exponent(law.exponent), found(fit, misfit.p));
  if (law.reference == paper::prefactor)
    section.claim("fig11.factor", words, PaperRange::roughly(paper::prefactor),
                  {.value = ratio.factor, .low = ratio.low, .high = ratio.high});
}

/// Returns the points of `groups` that are not in the curve `all`. Reports whether all points fall
/// on one curve, and how far the returned ones lie from the curve without them.
std::vector<CurvePoint> points_beside(const char* name, const MasterCurve& all,
                                      const std::vector<Groups>& groups, PaperSection& section) {
  const MasterCurve more = fit_master_curve(groups);
  std::vector<CurvePoint> others = more.points;
  std::erase_if(others, [&](const CurvePoint& point) {
    return std::ranges::any_of(all.points, [&](const CurvePoint& known) {
      return known.group.samples.front() == point.group.samples.front();
    });
  });
  if (others.empty()) return others;
  const Statistics offsets = statistics(values_of(others, [&](const CurvePoint& point) {
    return std::exp(point.log_rise()) / all.curve.at(point.x) - 1.0;
  }));
  section.report(name, {{"points", std::to_string(more.points.size())},
                        {"others", std::to_string(others.size())},
                        {"curve", words_of(more.curve_misfit)},
                        {"least", percent_words(offsets.min)},
                        {"mean", percent_words(offsets.mean)},
                        {"most", percent_words(offsets.max)}});
  return others;
}

}  // namespace

Eigen::VectorXd LogPolynomial::row(double x) const {
  Eigen::VectorXd powers(fit.value.size());
  for (Eigen::Index k = 0; k < powers.size(); ++k) powers[k] = std::pow(std::log(x / middle), k);
  return powers;
}

Eigen::VectorXd LogPolynomial::slope_row(double x) const {
  const Eigen::VectorXd powers = row(x);
  Eigen::VectorXd slope = Eigen::VectorXd::Zero(powers.size());
  for (Eigen::Index k = 1; k < slope.size(); ++k) slope[k] = k * powers[k - 1];
  return slope;
}

VarianceRatio misfit_of(const WeightedFit& fit, const PooledError& error) {
  if (error.degrees_of_freedom < 1) return {};
  return {fit.reduced_chi2(),
          f_test_p(fit.reduced_chi2(), fit.degrees_of_freedom, error.degrees_of_freedom)};
}

MasterCurve fit_master_curve(const std::vector<Groups>& groups) {
  MasterCurve all;
  all.points = distinct_points(groups);
  Groups distinct;
  for (const CurvePoint& point : all.points) distinct.push_back(point.group);
  all.between = scatter_between(distinct, "rise");
  all.paired = scatter_paired(distinct, "rise");
  if (!all.is_known()) return all;
  const auto [least, most] = std::ranges::minmax(all.points, {}, &CurvePoint::x);
  all.least = least.x;
  all.most = most.x;
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
  const WeightedFit shifted = fit_points(all.points, all.curve, 3, deviation, true);
  all.offsets = improvement(all.curve.fit, shifted);
  for (Eigen::Index k = 3; k < shifted.value.size(); ++k)
    if (!(std::abs(shifted.value[k]) <= std::abs(all.largest_offset))) {
      all.largest_offset = shifted.value[k];
      all.offset_error = std::sqrt(shifted.covariance(k, k));
    }
  return all;
}

void fill_curve(PaperData& data, PaperSection& section) {
  std::vector<Groups> groups;
  for (const Series& series : all_series) groups.push_back(data.groups(series.rows, series.along));
  const auto leave_out = [](std::vector<Groups>& all_groups, RunMeasure measure, double least) {
    for (Groups& series : all_groups)
      std::erase_if(series,
                    [&](const Group& group) { return (*group.samples.front())[measure] < least; });
  };
  // Eq. 3 supposes f_max >> f_g, and that all grains move along with the wall, which counts less
  // where the wall is heavy.
  leave_out(groups, "wall_mass_over_grains", least_wall);
  std::vector<Groups> larger = groups;
  leave_out(larger, "force_over_weight", least_load);
  const MasterCurve all = fit_master_curve(larger);
  if (!all.is_known()) return;
  const auto small_loads = points_beside("curve.small_loads", all, groups, section);
  larger.push_back(data.settings(light_wall.rows));
  const auto light = points_beside("curve.light_wall", all, larger, section);
  const page::Values words = words_for(all);
  section.draw("fig11b", {.height = 480, .panels = {prefactor_panel(all, small_loads, light)}},
               words);
  section.text.push_back(page::words("curve.theory", words));
  section.add(along_table(all));
  const double half = student_t95(all.between.degrees_of_freedom) * all.offset_error;
  Found grouping = Found::about(all.largest_offset, half, all.curve_misfit.p);
  grouping.is_whole = small_loads.empty() && light.empty();
  section.claim("curve.grouping", words, PaperRange::about(0.0, 0.1), grouping);
  section.report("curve.shape", words);
  section.report("curve.bend", words);
  report_box(data, section);
}

void add_laws(PaperData& data, PaperSection& section) {
  page::Table table = page::words_table("laws");
  for (const Law& law : all_laws())
    if (section.id == law.section) add_law(data, law, table, section);
  if (!table.rows.empty()) section.text.push_back(page::words("misfit"));
  section.add(std::move(table));
}

}  // namespace ballast
