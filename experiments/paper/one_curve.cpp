#include "experiments/paper/one_curve.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace ballast {
namespace {

/// What was set, so that the base run of all sweeps is known again.
std::array<double, 4> settings_of(const VariedValue& value) {
  const RunFacts& facts = value.samples.front().facts;
  return {facts.frequency, facts.f_max / facts.grain_mass, facts.gravity,
          facts.wall_mass / facts.grain_mass};
}

bool are_same(const VariedValue& a, const VariedValue& b) {
  const auto first = settings_of(a), second = settings_of(b);
  for (size_t k = 0; k < first.size(); ++k)
    if (std::abs(first[k] - second[k]) > 1e-6 * std::abs(first[k])) return false;
  return true;
}

std::vector<CurvePoint> distinct_points(const std::vector<std::vector<VariedValue>>& values) {
  std::vector<CurvePoint> points;
  for (size_t series = 0; series < values.size(); ++series)
    for (const VariedValue& value : values[series]) {
      CurvePoint point{series, value, value.samples.front().eq3()};
      const bool is_new = std::none_of(points.begin(), points.end(), [&](const CurvePoint& other) {
        return are_same(other.value, value);
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
    error[k] = deviation / std::sqrt(static_cast<double>(point.value.samples.size()));
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

/// Weights w with sum(w y) the least-squares slope of y on ln abscissa.
std::vector<double> slope_weights(const std::vector<double>& abscissas) {
  double mean = 0.0, squares = 0.0;
  for (const double a : abscissas) mean += std::log(a) / static_cast<double>(abscissas.size());
  for (const double a : abscissas) squares += std::pow(std::log(a) - mean, 2);
  std::vector<double> weights;
  for (const double a : abscissas) weights.push_back((std::log(a) - mean) / squares);
  return weights;
}

/// A series's exponent from its own points, and from the curve through the points of the others.
SeriesExponent exponent_of(size_t series, const std::vector<VariedValue>& values,
                           const OneCurve& all) {
  SeriesExponent result{series, static_cast<int>(values.size())};
  std::vector<CurvePoint> others;
  for (const CurvePoint& point : all.points) {
    const bool is_own = std::any_of(values.begin(), values.end(), [&](const VariedValue& value) {
      return are_same(value, point.value);
    });
    if (!is_own) others.push_back(point);
  }
  if (values.size() < 2 || others.size() < 5) return result;
  const LogPolynomial curve = polynomial(others, 3, all.weighing);
  std::vector<double> abscissas;
  for (const VariedValue& value : values)
    abscissas.push_back(abscissa_of(value, all_series()[series].varied));
  const std::vector<double> weights = slope_weights(abscissas);
  result.own = 0.0;
  double variance = 0.0;
  Eigen::VectorXd row = Eigen::VectorXd::Zero(3);
  double low = 1e300, high = 0.0;
  for (size_t k = 0; k < values.size(); ++k) {
    const CurvePoint point{series, values[k], values[k].samples.front().eq3()};
    result.own += weights[k] * point.log_rise();
    variance +=
        std::pow(weights[k] * all.weighing, 2) / static_cast<double>(values[k].samples.size());
    row += weights[k] * curve.row(point.x);
    low = std::min(low, point.x);
    high = std::max(high, point.x);
  }
  result.own_error = std::sqrt(variance);
  result.predicted = curve.fit.at(row);
  result.predicted_error = curve.fit.error_at(row);
  const auto [least, most] =
      std::minmax_element(others.begin(), others.end(),
                          [](const CurvePoint& a, const CurvePoint& b) { return a.x < b.x; });
  result.is_inside = least->x < 1.5 * low && most->x > high / 1.5;
  const Difference difference{result.own - result.predicted,
                              std::hypot(result.own_error, result.predicted_error),
                              all.between.degrees_of_freedom};
  result.p = difference.p();
  return result;
}

/// The bend of every packing's own curve.
SampleMean curvature_of(const OneCurve& all) {
  std::vector<int> seeds = all.points.front().value.seeds;
  std::vector<double> bends;
  for (const int seed : seeds) {
    std::vector<CurvePoint> own;
    for (const CurvePoint& point : all.points)
      if (const Observation* sample = point.value.of_seed(seed)) {
        own.push_back(point);
        own.back().value.samples = {Observation(*sample)};
        own.back().value.seeds = {seed};
      }
    if (own.size() > 4) bends.push_back(polynomial(own, 3, all.weighing).fit.value[2]);
  }
  return sample_mean(bends);
}

void add_offsets(OneCurve& all) {
  const WeightedFit shifted = fit_points(all.points, all.curve, 3, all.weighing, true);
  all.offsets = improvement(all.curve.fit, shifted);
  for (Eigen::Index k = 3; k < shifted.value.size(); ++k)
    if (!(std::abs(shifted.value[k]) <= std::abs(all.largest_offset))) {
      all.largest_offset = shifted.value[k];
      all.offset_error = std::sqrt(shifted.covariance(k, k));
    }
}

}  // namespace

std::span<const Series> all_series() {
  static constexpr std::array all{
      Series{Varied::frequency, "ν", "ν", Ink::blue, MarkShape::triangle, -2.0},
      Series{Varied::force, "f_max", "f_{max}", Ink::vermilion, MarkShape::circle, -1.0},
      Series{Varied::gravity, "g", "g", Ink::green, MarkShape::square, 2.0},
      Series{Varied::wall_mass, "m_w", "m_w", Ink::purple, MarkShape::diamond, 1.0}};
  return all;
}

double abscissa_of(const VariedValue& value, Varied varied) {
  const RunFacts& facts = value.samples.front().facts;
  if (varied == Varied::gravity) return facts.gravity;
  if (varied == Varied::wall_mass) return facts.grain_mass / (facts.grain_mass + facts.wall_mass);
  return value.value;  // nu; f_max over the weight under 9.81 m/s^2, the same for all seeds
}

double CurvePoint::log_rise() const { return sample_mean(logs_of(value, &Observation::rise)).mean; }

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

OneCurve one_curve(const std::vector<std::vector<VariedValue>>& values) {
  OneCurve all;
  all.points = distinct_points(values);
  std::vector<VariedValue> distinct;
  for (const CurvePoint& point : all.points) distinct.push_back(point.value);
  all.between = scatter_between(distinct, &Observation::rise);
  all.paired = scatter_paired(distinct, &Observation::rise);
  if (!all.is_known()) return all;
  // with one sample of each point no errors are known: then every point weighs the same
  all.weighing = all.between.degrees_of_freedom > 0 ? all.between.deviation : 1.0;
  all.line = polynomial(all.points, 2, all.weighing);
  all.curve = polynomial(all.points, 3, all.weighing);
  all.cubic = polynomial(all.points, 4, all.weighing);
  all.line_misfit = misfit_of(all.line.fit, all.between);
  all.curve_misfit = misfit_of(all.curve.fit, all.between);
  if (all.paired.degrees_of_freedom > 0)
    all.paired_misfit = misfit_of(polynomial(all.points, 3, all.paired.deviation).fit, all.paired);
  all.bend = improvement(all.line.fit, all.curve.fit);
  all.third = improvement(all.curve.fit, all.cubic.fit);
  add_offsets(all);
  for (size_t series = 0; series < values.size(); ++series)
    if (values[series].size() > 1)
      all.exponents.push_back(exponent_of(series, values[series], all));
  all.curvature = curvature_of(all);
  return all;
}

double force_of_prefactor(double prefactor) {
  return 2.0 / 3.0 * std::numbers::pi * std::sqrt(prefactor);
}

}  // namespace ballast
