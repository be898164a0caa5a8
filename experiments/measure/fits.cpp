#include "experiments/measure/fits.hpp"

#include <algorithm>
#include <cmath>

namespace ballast {
namespace {

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

SampleMean sample_mean(std::span<const double> values) {
  std::vector<double> finite;
  for (const double value : values)
    if (std::isfinite(value)) finite.push_back(value);
  SampleMean result;
  result.samples = static_cast<int>(finite.size());
  if (finite.empty()) return result;
  const Spread spread = spread_of(finite);
  result.mean = spread.mean;
  result.error = spread.deviation / std::sqrt(static_cast<double>(finite.size()));
  return result;
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

double reduced_chi2(const PowerFit& fit, std::span<const double> x, std::span<const double> y,
                    std::span<const double> error) {
  double misses = 0.0, variances = 0.0;
  int points = 0;
  for (size_t k = 0; k < std::min({x.size(), y.size(), error.size()}); ++k) {
    if (!(x[k] > 0.0 && y[k] > 0.0) || !std::isfinite(error[k])) continue;
    // for small errors the error of log y is the relative error of y
    const double miss = std::log(y[k] / fit.at(x[k])), relative = error[k] / y[k];
    misses += miss * miss;
    variances += relative * relative;
    ++points;
  }
  if (points < 3 || !std::isfinite(misses) || !(variances > 0.0)) return not_known;
  // Squared misses per degree of freedom, over the mean variance: about one where the power law
  // misses the points by no more than their errors.
  return misses / (points - 2) / (variances / points);
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

}  // namespace ballast
