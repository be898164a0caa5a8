#include "experiments/measure/curve_fit.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <numbers>
#include <numeric>
#include <stdexcept>
#include <unsupported/Eigen/SpecialFunctions>

namespace ballast {
namespace {

using Eigen::ArrayXd;

std::vector<double> finite_of(std::span<const double> values) {
  std::vector<double> finite;
  for (const double value : values)
    if (std::isfinite(value)) finite.push_back(value);
  return finite;
}

/// The samples whose x and y are both finite.
struct Samples {
  ArrayXd x, y;
};

Samples finite_samples(std::span<const double> x, std::span<const double> y) {
  if (x.size() != y.size()) throw std::invalid_argument("a fit needs as many x as y");
  std::vector<double> both[2];
  for (size_t k = 0; k < x.size(); ++k)
    if (std::isfinite(x[k]) && std::isfinite(y[k])) {
      both[0].push_back(x[k]);
      both[1].push_back(y[k]);
    }
  const auto count = static_cast<Eigen::Index>(both[0].size());
  return {Eigen::Map<ArrayXd>(both[0].data(), count), Eigen::Map<ArrayXd>(both[1].data(), count)};
}

double determination(double residual_squares, const ArrayXd& y) {
  const double total = (y - y.mean()).square().sum();
  return total > 0.0 ? 1.0 - residual_squares / total : not_known;
}

/// Fit of y = amplitude shape for a fixed shape: the best amplitude, or the given one, and the sum
/// of squared residuals. A shape with one parameter is fitted by the least residual over that
/// parameter.
struct Projection {
  double amplitude, residual;
};
Projection project(const ArrayXd& shape, const ArrayXd& y, double given = not_known) {
  const double amplitude = std::isfinite(given) ? given : (shape * y).sum() / shape.square().sum();
  return {amplitude, (y - amplitude * shape).square().sum()};
}

/// Eq. 5 with D = 1: proportional to nu up to nu_c, to 1 / nu from there on, and continuous.
ArrayXd peaked_shape(const ArrayXd& frequency, double critical) {
  return (frequency <= critical).select(frequency, critical * critical / frequency);
}

}  // namespace

Statistics statistics(std::span<const double> values) {
  const std::vector<double> finite = finite_of(values);
  if (finite.empty()) return {};
  return {std::accumulate(finite.begin(), finite.end(), 0.0) / static_cast<double>(finite.size()),
          std::ranges::min(finite), std::ranges::max(finite), std::ssize(finite)};
}

double quantile(std::span<const double> values, double p) {
  std::vector<double> sorted = finite_of(values);
  if (sorted.empty()) return not_known;
  std::sort(sorted.begin(), sorted.end());
  // Interpolates in the rank: p = 0 is the least sample, p = 1 the largest.
  const double at = p * static_cast<double>(sorted.size() - 1);
  const size_t below = static_cast<size_t>(at), above = std::min(below + 1, sorted.size() - 1);
  return sorted[below] + (at - static_cast<double>(below)) * (sorted[above] - sorted[below]);
}

std::vector<double> low_pass(std::span<const double> y, int width) {
  std::vector<double> smooth(y.begin(), y.end());
  const int half = width / 2;
  if (half < 1) return smooth;
  // the Hann window's right half; it is symmetric
  std::vector<double> weight(half + 1);
  for (int k = 0; k <= half; ++k)
    weight[k] = 0.5 * (1.0 + std::cos(std::numbers::pi * k / (half + 1)));
  const int count = static_cast<int>(y.size());
  for (int k = 0; k < count; ++k) {
    if (!std::isfinite(y[k])) continue;
    // weights without a sample are missing from both sums, so that the mean stays a mean
    double sum = 0.0, weights = 0.0;
    for (int j = std::max(0, k - half); j <= std::min(count - 1, k + half); ++j) {
      if (!std::isfinite(y[j])) continue;
      sum += weight[std::abs(j - k)] * y[j];
      weights += weight[std::abs(j - k)];
    }
    smooth[k] = sum / weights;
  }
  return smooth;
}

LineFit fit_line(std::span<const double> x, std::span<const double> y) {
  const Samples samples = finite_samples(x, y);
  LineFit fit;
  fit.samples = samples.x.size();
  if (fit.samples < 2) return fit;
  // about the means, as sums of large x would lose digits
  const double mean_x = samples.x.mean(), mean_y = samples.y.mean();
  const ArrayXd dx = samples.x - mean_x, dy = samples.y - mean_y;
  const double xx = dx.square().sum();
  if (!(xx > 0.0)) return fit;  // all x alike: no slope
  fit.slope = (dx * dy).sum() / xx;
  fit.offset = mean_y - fit.slope * mean_x;
  const double residual = (dy - fit.slope * dx).square().sum();
  fit.r2 = determination(residual, samples.y);
  // the slope's variance is s^2 / xx; two parameters take two degrees of freedom of s
  if (fit.samples > 2) fit.slope_error = std::sqrt(residual / (fit.samples - 2) / xx);
  return fit;
}

ExponentialFit fit_exponential(std::span<const double> x, std::span<const double> y) {
  const Samples samples = finite_samples(x, y);
  if (samples.x.size() < 2) return {};
  // x is counted from its minimum in units of its range, so that rates are pure numbers and nothing
  // overflows
  const double origin = samples.x.minCoeff(), range = samples.x.maxCoeff() - origin;
  if (!(range > 0.0)) return {};
  const ArrayXd place = (samples.x - origin) / range;
  const auto at = [&](double rate) { return project((rate * place).exp(), samples.y); };
  // Only the rate is searched, as the amplitude follows from it: first factors e^-20 ... e^20
  // across the range of x, then ever finer about the best one.
  double rate = 0.0, least = at(rate).residual;
  int half = 80;  // steps to each side
  for (double step = 0.25; step > 1e-10; step *= 0.25) {
    const double middle = rate;
    for (int k = -half; k <= half; ++k)
      if (const double residual = at(middle + step * k).residual; residual < least) {
        least = residual;
        rate = middle + step * k;
      }
    half = 4;
  }
  return {at(rate).amplitude * std::exp(-rate / range * origin), rate / range,
          determination(least, samples.y)};
}

double t_test_p(double t, double degrees_of_freedom) {
  return f_test_p(t * t, 1.0, degrees_of_freedom);
}

double student_t95(int degrees_of_freedom) {
  if (degrees_of_freedom < 1) return std::numeric_limits<double>::infinity();
  // p falls with t: bisection upwards from the bound of the normal distribution
  double low = 1.9, high = 13.0;
  for (int k = 0; k < 60; ++k) {
    const double middle = 0.5 * (low + high);
    (t_test_p(middle, degrees_of_freedom) > 0.05 ? low : high) = middle;
  }
  return low;
}

double f_test_p(double ratio, double above, double below) {
  if (!(above > 0.0) || !(below > 0.0) || std::isnan(ratio)) return not_known;
  // beyond this many degrees of freedom nothing changes in the fourth digit
  const double bounded = std::min(below, 1e6);
  return Eigen::numext::betainc(0.5 * bounded, 0.5 * above,
                                bounded / (bounded + above * std::max(ratio, 0.0)));
}

std::vector<double> holm(std::span<const double> p) {
  std::vector<size_t> order;
  for (size_t k = 0; k < p.size(); ++k)
    if (std::isfinite(p[k])) order.push_back(k);
  std::sort(order.begin(), order.end(), [&](size_t a, size_t b) { return p[a] < p[b]; });
  // The smallest p is multiplied by the number of tests, the next by one less, and so on; none may
  // become smaller than the one before it.
  std::vector<double> corrected(p.size(), not_known);
  double least = 0.0;
  for (size_t k = 0; k < order.size(); ++k) {
    least = std::max(least, std::min(1.0, static_cast<double>(order.size() - k) * p[order[k]]));
    corrected[order[k]] = least;
  }
  return corrected;
}

SampleMean sample_mean(std::span<const double> values) {
  const std::vector<double> finite = finite_of(values);
  SampleMean mean;
  mean.samples = static_cast<int>(finite.size());
  if (finite.empty()) return mean;
  mean.mean = 0.0;
  for (const double value : finite) mean.mean += value / mean.samples;
  double squares = 0.0;
  for (const double value : finite) squares += (value - mean.mean) * (value - mean.mean);
  if (mean.samples > 1)
    mean.error = std::sqrt(squares / (mean.samples - 1)) / std::sqrt(mean.samples);
  return mean;
}

PooledError pooled_error(std::span<const std::vector<double>> groups) {
  PooledError pooled;
  double squares = 0.0;
  for (const std::vector<double>& group : groups) {
    const SampleMean mean = sample_mean(group);
    if (mean.samples < 2) continue;
    squares += mean.deviation() * mean.deviation() * (mean.samples - 1);
    pooled.degrees_of_freedom += mean.samples - 1;
  }
  if (pooled.degrees_of_freedom > 0)
    pooled.deviation = std::sqrt(squares / pooled.degrees_of_freedom);
  return pooled;
}

VarianceRatio repeated_anova(std::span<const std::vector<double>> groups) {
  const size_t kinds = groups.size(), samples = kinds > 0 ? groups.front().size() : 0;
  if (kinds < 2 || samples < 2) return {};
  Eigen::MatrixXd all(samples, kinds);
  for (size_t k = 0; k < kinds; ++k) {
    if (groups[k].size() != samples) return {};
    all.col(k) = Eigen::Map<const Eigen::VectorXd>(groups[k].data(), samples);
  }
  all.colwise() -= Eigen::VectorXd(all.rowwise().mean());
  const Eigen::RowVectorXd means = all.colwise().mean();
  all.rowwise() -= means;
  const double above = kinds - 1.0, below = above * (samples - 1.0);
  const double between = samples * means.squaredNorm() / above, within = all.squaredNorm() / below;
  return {between / within, f_test_p(between / within, above, below)};
}

void Points::add(double at, const SampleMean& mean) {
  x.push_back(at);
  y.push_back(mean.mean);
  error.push_back(mean.error);
  error_dof += std::max(0, mean.samples - 1);
}

PowerFit fit_power(std::span<const double> x, std::span<const double> y) {
  const auto logarithm = [](double value) { return value > 0.0 ? std::log(value) : not_known; };
  const LineFit line = fit_line(values_of(x, logarithm), values_of(y, logarithm));
  return {line.slope, std::exp(line.offset), student_t95(line.samples - 2) * line.slope_error,
          line.r2, line.samples};
}

VarianceRatio misfit_of(const Points& points) {
  double misses = 0.0, variances = 0.0;
  std::vector<double> x, y;
  for (size_t k = 0; k < points.x.size(); ++k) {
    if (!(points.x[k] > 0.0 && points.y[k] > 0.0) || !std::isfinite(points.error[k])) continue;
    x.push_back(points.x[k]);
    y.push_back(points.y[k]);
    // for small errors the error of log y is the relative error of y
    const double relative = points.error[k] / y.back();
    variances += relative * relative;
  }
  const PowerFit fit = fit_power(x, y);
  const auto counted = static_cast<int>(x.size());
  for (size_t k = 0; k < x.size(); ++k) {
    const double miss = std::log(y[k] / fit.at(x[k]));
    misses += miss * miss;
  }
  if (counted < 3 || !std::isfinite(misses) || !(variances > 0.0)) return {};
  const double reduced_chi2 = misses / (counted - 2) / (variances / counted);
  // the errors come from few samples: the ratio is one of two variances, not chi^2 of known errors
  return {reduced_chi2, f_test_p(reduced_chi2, counted - 2, points.error_dof)};
}

Proportion fit_proportion(std::span<const double> x, std::span<const double> y) {
  std::vector<double> logs;
  for (size_t k = 0; k < std::min(x.size(), y.size()); ++k)
    if (x[k] > 0.0 && y[k] > 0.0) logs.push_back(std::log(y[k] / x[k]));
  const SampleMean mean = sample_mean(logs);
  const double half = mean.half_width();
  return {std::exp(mean.mean), std::exp(mean.mean - half), std::exp(mean.mean + half),
          std::exp(mean.deviation())};
}

double PeakedRate::at(double frequency) const {
  return gain * peaked_shape(ArrayXd::Constant(1, frequency), critical)[0];
}

PeakedRate fit_peaked_rate(std::span<const double> frequency, std::span<const double> rate,
                           double gain) {
  const auto [x, y] = finite_samples(frequency, rate);
  PeakedRate fit;
  if (x.size() < 3) return fit;
  // Once nu_c is chosen the best gain follows (the rate is linear in it), so nu_c alone is scanned:
  // evenly in log nu_c, between the least and the largest frequency.
  constexpr int parts = 4000;  // 0.1 % of nu_c over two decades: finer than any interval it gives
  const auto critical = [low = x.minCoeff(), ratio = x.maxCoeff() / x.minCoeff()](int k) {
    return low * std::pow(ratio, static_cast<double>(k) / parts);
  };
  std::vector<double> residual;
  for (int k = 0; k <= parts; ++k)
    residual.push_back(project(peaked_shape(x, critical(k)), y, gain).residual);
  const auto best = std::min_element(residual.begin(), residual.end());
  fit.critical = critical(static_cast<int>(best - residual.begin()));
  fit.gain = project(peaked_shape(x, fit.critical), y, gain).amplitude;
  fit.r2 = determination(*best, y);
  // The interval of nu_c: where the sum of squared residuals S(nu_c) <= S_least (1 + t^2 / (n -
  // parameters)), with t at 95 %.
  const int freedom = static_cast<int>(x.size()) - (std::isfinite(gain) ? 1 : 2);
  const double t = student_t95(freedom), bound = *best * (1.0 + t * t / freedom) + 1e-300;
  fit.low = fit.high = fit.critical;
  for (int k = 0; k <= parts; ++k)
    if (residual[static_cast<size_t>(k)] <= bound) {
      fit.low = std::min(fit.low, critical(k));
      fit.high = std::max(fit.high, critical(k));
    }
  return fit;
}

WeightedFit fit_weighted(const Eigen::MatrixXd& design, const Eigen::VectorXd& y,
                         const Eigen::VectorXd& error) {
  // Rows in units of their errors make it ordinary least squares, solved by the normal equations.
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

VarianceRatio improvement(const WeightedFit& less, const WeightedFit& more) {
  const int further = less.degrees_of_freedom - more.degrees_of_freedom;
  if (further < 1 || more.degrees_of_freedom < 1) return {};
  const double ratio = (less.chi2 - more.chi2) / further / more.reduced_chi2();
  return {ratio, f_test_p(ratio, further, more.degrees_of_freedom)};
}

}  // namespace ballast
