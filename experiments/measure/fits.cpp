#include "experiments/measure/fits.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

namespace ballast {
namespace {

/// A divisor that is not zero: what Lentz's method needs.
double away_from_zero(double value) { return std::abs(value) < 1e-300 ? 1e-300 : value; }

/// Continued fraction of the incomplete beta function by Lentz's method (Abramowitz and Stegun
/// 26.5.8). Converges fast for x < (a + 1)/(a + b + 2).
double beta_fraction(double a, double b, double x) {
  double c = 1.0, d = 1.0 / away_from_zero(1.0 - (a + b) * x / (a + 1.0)), fraction = d;
  for (int m = 1; m < 10000; ++m) {
    double change = 1.0;
    // the two coefficients of a round: even, then odd
    const double even = m * (b - m) * x / ((a + 2.0 * m - 1.0) * (a + 2.0 * m)),
                 odd = -(a + m) * (a + b + m) * x / ((a + 2.0 * m) * (a + 2.0 * m + 1.0));
    for (const double coefficient : {even, odd}) {
      d = 1.0 / away_from_zero(1.0 + coefficient * d);
      c = away_from_zero(1.0 + coefficient / c);
      change *= c * d;
    }
    fraction *= change;
    if (std::abs(change - 1.0) < 1e-15) break;
  }
  return fraction;
}

/// Regularised incomplete beta function I_x(a, b).
double incomplete_beta(double a, double b, double x) {
  if (x <= 0.0) return 0.0;
  if (x >= 1.0) return 1.0;
  const double factor = std::exp(std::lgamma(a + b) - std::lgamma(a) - std::lgamma(b) +
                                 a * std::log(x) + b * std::log1p(-x));
  // the side on which the fraction converges fast
  return x < (a + 1.0) / (a + b + 2.0) ? factor * beta_fraction(a, b, x) / a
                                       : 1.0 - factor * beta_fraction(b, a, 1.0 - x) / b;
}

std::vector<double> finite_of(std::span<const double> values) {
  std::vector<double> finite;
  for (const double value : values)
    if (std::isfinite(value)) finite.push_back(value);
  return finite;
}

/// Mean and standard deviation (n - 1).
struct Spread {
  double mean = 0.0, deviation = not_known;
};

Spread spread_of(std::span<const double> values) {
  Spread spread;
  for (const double value : values) spread.mean += value / static_cast<double>(values.size());
  double squares = 0.0;
  for (const double value : values) squares += (value - spread.mean) * (value - spread.mean);
  if (values.size() > 1)
    spread.deviation = std::sqrt(squares / static_cast<double>(values.size() - 1));
  return spread;
}

/// Eq. 5 with D = 1.
double peaked_shape(double frequency, double critical) {
  // Proportional to nu up to nu_c, to 1 / nu from there on, and continuous.
  return frequency <= critical ? frequency : critical * critical / frequency;
}

/// Squared residuals about amplitude times shape.
template <class Shape>
double missed(const std::vector<double>& x, const std::vector<double>& y, double amplitude,
              const Shape& shape) {
  double squares = 0.0;
  for (size_t k = 0; k < x.size(); ++k) squares += std::pow(y[k] - amplitude * shape(x[k]), 2);
  return squares;
}

}  // namespace

double student_p(double t, double degrees_of_freedom) {
  if (!(degrees_of_freedom > 0.0) || std::isnan(t)) return not_known;
  return incomplete_beta(0.5 * degrees_of_freedom, 0.5,
                         degrees_of_freedom / (degrees_of_freedom + t * t));
}

double student_t95(int degrees_of_freedom) {
  if (degrees_of_freedom < 1) return std::numeric_limits<double>::infinity();
  // p falls with t: bisection, from the normal distribution's bound up
  double low = 1.9, high = 13.0;
  for (int k = 0; k < 60; ++k) {
    const double middle = 0.5 * (low + high);
    (student_p(middle, degrees_of_freedom) > 0.05 ? low : high) = middle;
  }
  return low;
}

double f_p(double ratio, double above, double below) {
  if (!(above > 0.0) || !(below > 0.0) || std::isnan(ratio)) return not_known;
  // beyond this many degrees of freedom nothing changes in the fourth digit
  const double bounded = std::min(below, 1e6);
  return incomplete_beta(0.5 * bounded, 0.5 * above,
                         bounded / (bounded + above * std::max(ratio, 0.0)));
}

std::vector<double> holm(std::span<const double> p) {
  std::vector<size_t> order;
  for (size_t k = 0; k < p.size(); ++k)
    if (std::isfinite(p[k])) order.push_back(k);
  std::sort(order.begin(), order.end(), [&](size_t a, size_t b) { return p[a] < p[b]; });
  // the smallest counts as often as there are questions, the next once less, and none may become
  // smaller than one before it
  std::vector<double> corrected(p.size(), not_known);
  double least = 0.0;
  for (size_t k = 0; k < order.size(); ++k) {
    least = std::max(least, std::min(1.0, static_cast<double>(order.size() - k) * p[order[k]]));
    corrected[order[k]] = least;
  }
  return corrected;
}

double SampleMean::half_width() const { return student_t95(samples - 1) * error; }
double SampleMean::p() const { return student_p(mean / error, samples - 1); }

SampleMean sample_mean(std::span<const double> values) {
  const std::vector<double> finite = finite_of(values);
  if (finite.empty()) return {};
  const Spread spread = spread_of(finite);
  return {spread.mean, spread.deviation / std::sqrt(static_cast<double>(finite.size())),
          static_cast<int>(finite.size())};
}

PooledError pooled_error(std::span<const std::vector<double>> groups) {
  PooledError pooled;
  double squares = 0.0;
  for (const std::vector<double>& group : groups) {
    const std::vector<double> finite = finite_of(group);
    if (finite.size() < 2) continue;
    const double mean = spread_of(finite).mean;
    for (const double value : finite) squares += (value - mean) * (value - mean);
    pooled.degrees_of_freedom += static_cast<int>(finite.size()) - 1;
  }
  if (pooled.degrees_of_freedom > 0)
    pooled.deviation = std::sqrt(squares / pooled.degrees_of_freedom);
  return pooled;
}

void Points::add(double at, const SampleMean& mean) {
  x.push_back(at);
  y.push_back(mean.mean);
  error.push_back(mean.error);
  errors_from += std::max(0, mean.samples - 1);
}

void Points::add(const Points& others) {
  x.insert(x.end(), others.x.begin(), others.x.end());
  y.insert(y.end(), others.y.begin(), others.y.end());
  error.insert(error.end(), others.error.begin(), others.error.end());
  errors_from += others.errors_from;
}

double PowerFit::at(double x) const { return prefactor * std::pow(x, exponent); }

PowerFit fit_power(std::span<const double> x, std::span<const double> y) {
  const auto logarithm = [](double value) { return value > 0.0 ? std::log(value) : not_known; };
  std::vector<double> log_x, log_y;
  for (const double value : x) log_x.push_back(logarithm(value));
  for (const double value : y) log_y.push_back(logarithm(value));
  // a power law is a line of the logarithms, and its exponent the slope
  const LineFit line = fit_line(log_x, log_y);
  PowerFit fit;
  fit.samples = line.samples;
  fit.exponent = line.slope;
  fit.prefactor = std::exp(line.offset);
  fit.r2 = line.r2;
  fit.half_width = student_t95(line.samples - 2) * line.slope_error;
  return fit;
}

Misfit misfit_of(const PowerFit& fit, const Points& points) {
  double misses = 0.0, variances = 0.0;
  int counted = 0;
  for (size_t k = 0; k < points.x.size(); ++k) {
    const double x = points.x[k], y = points.y[k];
    if (!(x > 0.0 && y > 0.0) || !std::isfinite(points.error[k])) continue;
    // for small errors the error of log y is the relative error of y
    const double miss = std::log(y / fit.at(x)), relative = points.error[k] / y;
    misses += miss * miss;
    variances += relative * relative;
    ++counted;
  }
  if (counted < 3 || !std::isfinite(misses) || !(variances > 0.0)) return {};
  const double reduced = misses / (counted - 2) / (variances / counted);
  // the errors come from few samples: a ratio of two variances, not chi^2 of known errors
  return {reduced, f_p(reduced, fit.samples - 2, points.errors_from)};
}

Proportion fit_proportion(std::span<const double> x, std::span<const double> y) {
  std::vector<double> logs;
  for (size_t k = 0; k < std::min(x.size(), y.size()); ++k)
    if (x[k] > 0.0 && y[k] > 0.0 && std::isfinite(x[k]) && std::isfinite(y[k]))
      logs.push_back(std::log(y[k] / x[k]));
  Proportion fit;
  fit.samples = static_cast<int>(logs.size());
  if (logs.empty()) return fit;
  // the mean of logarithms is the geometric mean; its interval is a factor
  const Spread spread = spread_of(logs);
  const double half =
      student_t95(fit.samples - 1) * spread.deviation / std::sqrt(static_cast<double>(fit.samples));
  fit.factor = std::exp(spread.mean);
  fit.low = std::exp(spread.mean - half);
  fit.high = std::exp(spread.mean + half);
  fit.spread = std::exp(spread.deviation);
  return fit;
}

double PeakedRate::at(double frequency) const { return gain * peaked_shape(frequency, critical); }

PeakedRate fit_peaked_rate(std::span<const double> frequency, std::span<const double> rate,
                           double gain) {
  // Eq. 5: the rate is D nu up to nu_c and D nu_c^2 / nu beyond, D the gain of a period.
  std::vector<double> x, y;
  for (size_t k = 0; k < std::min(frequency.size(), rate.size()); ++k)
    if (std::isfinite(rate[k]) && frequency[k] > 0.0) {
      x.push_back(frequency[k]);
      y.push_back(rate[k]);
    }
  PeakedRate fit;
  fit.samples = static_cast<int>(y.size());
  if (fit.samples < 3) return fit;
  // Once nu_c is chosen the best gain follows (the rate is linear in it), so nu_c alone is scanned.
  const auto at = [&](double critical) {
    const auto shape = [&](double nu) { return peaked_shape(nu, critical); };
    return std::isfinite(gain) ? Projection{gain, missed(x, y, gain, shape)} : project(x, y, shape);
  };
  // evenly in log nu_c, between the least and the largest frequency
  const auto [least, most] = std::minmax_element(x.begin(), x.end());
  constexpr int parts = 4000;  // 0.1 % of nu_c over two decades: finer than any interval it gives
  const auto critical = [low = *least, ratio = *most / *least](int k) {
    return low * std::pow(ratio, static_cast<double>(k) / parts);
  };
  std::vector<double> residual;
  for (int k = 0; k <= parts; ++k) residual.push_back(at(critical(k)).residual);
  const auto best = std::min_element(residual.begin(), residual.end());
  fit.critical = critical(static_cast<int>(best - residual.begin()));
  fit.gain = at(fit.critical).amplitude;
  // R^2 against the mean alone
  double total = 0.0;
  const double mean = spread_of(y).mean;
  for (const double value : y) total += (value - mean) * (value - mean);
  if (total > 0.0) fit.r2 = 1.0 - *best / total;
  // where the squared residuals exceed the least by what t at 95 % allows: S(nu_c) <= S_least (1 +
  // t^2 / (n - parameters))
  const int freedom = fit.samples - (std::isfinite(gain) ? 1 : 2);
  const double t = student_t95(freedom), bound = *best * (1.0 + t * t / freedom) + 1e-300;
  fit.low = fit.high = fit.critical;
  for (int k = 0; k <= parts; ++k)
    if (residual[static_cast<size_t>(k)] <= bound) {
      fit.low = std::min(fit.low, critical(k));
      fit.high = std::max(fit.high, critical(k));
    }
  return fit;
}

double WeightedFit::error_at(const Eigen::VectorXd& row) const {
  return std::sqrt(row.dot(covariance * row));
}

WeightedFit fit_weighted(const Eigen::MatrixXd& design, const Eigen::VectorXd& y,
                         const Eigen::VectorXd& error) {
  // every row in units of its error: then ordinary least squares, by the normal equations
  const Eigen::VectorXd weight = error.cwiseInverse();
  const Eigen::MatrixXd scaled = weight.asDiagonal() * design;
  const Eigen::VectorXd target = weight.cwiseProduct(y);
  WeightedFit fit;
  const Eigen::Index values = design.cols();
  const Eigen::LDLT<Eigen::MatrixXd> normal(scaled.transpose() * scaled);
  fit.value = normal.solve(scaled.transpose() * target);
  fit.covariance = normal.solve(Eigen::MatrixXd::Identity(values, values));
  fit.chi2 = (target - scaled * fit.value).squaredNorm();
  fit.degrees_of_freedom = static_cast<int>(design.rows() - values);
  return fit;
}

Improvement improvement(const WeightedFit& less, const WeightedFit& more) {
  const int further = less.degrees_of_freedom - more.degrees_of_freedom;
  if (further < 1 || more.degrees_of_freedom < 1) return {};
  const double ratio = (less.chi2 - more.chi2) / further / more.reduced();
  return {ratio, f_p(ratio, further, more.degrees_of_freedom)};
}

}  // namespace ballast
