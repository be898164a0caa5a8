#include "experiments/measure/significance.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

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

double mean_of(const std::vector<double>& values) {
  return std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
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

PooledError pooled_error(std::span<const std::vector<double>> groups) {
  PooledError pooled;
  double squares = 0.0;
  for (const std::vector<double>& group : groups) {
    const std::vector<double> finite = finite_of(group);
    if (finite.size() < 2) continue;
    const double mean = mean_of(finite);
    for (const double value : finite) squares += (value - mean) * (value - mean);
    pooled.degrees_of_freedom += static_cast<int>(finite.size()) - 1;
  }
  if (pooled.degrees_of_freedom > 0)
    pooled.deviation = std::sqrt(squares / pooled.degrees_of_freedom);
  return pooled;
}

double Difference::p() const { return student_p(mean / error, degrees_of_freedom); }

double Difference::half_width() const { return student_t95(degrees_of_freedom) * error; }

Difference paired_difference(std::span<const double> a, std::span<const double> b) {
  std::vector<double> differences;
  for (size_t k = 0; k < std::min(a.size(), b.size()); ++k) differences.push_back(b[k] - a[k]);
  const std::vector<double> finite = finite_of(differences);
  if (finite.empty()) return {};
  const PooledError spread = pooled_error(std::span(&finite, 1));
  return {mean_of(finite), spread.deviation / std::sqrt(static_cast<double>(finite.size())),
          spread.degrees_of_freedom};
}

}  // namespace ballast
