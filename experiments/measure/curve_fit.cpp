#include "experiments/measure/curve_fit.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>

namespace ballast {
namespace {

/// The samples where both are finite.
struct Samples {
  std::vector<double> x, y;
  int count() const { return static_cast<int>(x.size()); }
};

Samples finite_samples(std::span<const double> x, std::span<const double> y) {
  if (x.size() != y.size()) throw std::invalid_argument("a fit needs as many x as y");
  Samples samples;
  for (size_t k = 0; k < x.size(); ++k)
    if (std::isfinite(x[k]) && std::isfinite(y[k])) {
      samples.x.push_back(x[k]);
      samples.y.push_back(y[k]);
    }
  return samples;
}

double mean_of(const std::vector<double>& values) {
  double sum = 0.0;
  for (double value : values) sum += value;
  return sum / static_cast<double>(values.size());
}

/// Sum of squares about the mean.
double total_squares(const std::vector<double>& values) {
  const double mean = mean_of(values);
  double sum = 0.0;
  for (double value : values) sum += (value - mean) * (value - mean);
  return sum;
}

double determination(double residual_squares, double total) {
  return total > 0.0 ? 1.0 - residual_squares / total : not_known;
}

/// Minimum of a function that has one minimum in [a, b].
template <class Function>
double golden_section(const Function& f, double a, double b) {
  // With ratio^2 = 1 - ratio an inner point of one interval is an inner point of the next, too.
  const double ratio = 0.5 * (std::sqrt(5.0) - 1.0);
  // two inner points; of each shorter interval one of them is known already
  double c = b - ratio * (b - a), d = a + ratio * (b - a);
  double fc = f(c), fd = f(d);
  for (int k = 0; k < 80 && b - a > 1e-12; ++k) {
    if (fc < fd) {
      b = d;
      d = c;
      fd = fc;
      c = b - ratio * (b - a);
      fc = f(c);
    } else {
      a = c;
      c = d;
      fc = fd;
      d = a + ratio * (b - a);
      fd = f(d);
    }
  }
  return 0.5 * (a + b);
}

}  // namespace

double ExponentialFit::at(double x) const { return amplitude * std::exp(rate * x); }

LineFit fit_line(std::span<const double> x, std::span<const double> y) {
  const Samples samples = finite_samples(x, y);
  LineFit fit;
  fit.samples = samples.count();
  if (fit.samples < 2) return fit;
  const double mean_x = mean_of(samples.x), mean_y = mean_of(samples.y);
  // about the means: sums of large x would lose digits
  double xx = 0.0, xy = 0.0;
  for (int k = 0; k < fit.samples; ++k) {
    xx += (samples.x[k] - mean_x) * (samples.x[k] - mean_x);
    xy += (samples.x[k] - mean_x) * (samples.y[k] - mean_y);
  }
  if (!(xx > 0.0)) return fit;  // all x alike: no slope
  fit.slope = xy / xx;
  fit.offset = mean_y - fit.slope * mean_x;
  double residual = 0.0;
  for (int k = 0; k < fit.samples; ++k) {
    const double miss = samples.y[k] - mean_y - fit.slope * (samples.x[k] - mean_x);
    residual += miss * miss;
  }
  fit.r2 = determination(residual, total_squares(samples.y));
  // two parameters take two degrees of freedom
  // The slope's variance is s^2 / xx, with s^2 the residual's.
  if (fit.samples > 2) fit.slope_error = std::sqrt(residual / (fit.samples - 2) / xx);
  return fit;
}

ExponentialFit fit_exponential(std::span<const double> x, std::span<const double> y) {
  const Samples samples = finite_samples(x, y);
  ExponentialFit fit;
  fit.samples = samples.count();
  if (fit.samples < 2) return fit;
  const auto [low, high] = std::minmax_element(samples.x.begin(), samples.x.end());
  if (!(*high > *low)) return fit;
  // x counts from its least in units of its range, so that rates are pure numbers and nothing
  // overflows
  const double origin = *low, range = *high - *low;
  // y = A exp(rate x) is linear in A: for a rate the best A follows,
  // and the rate alone is searched.
  const auto projected = [&](double rate) {
    return project(samples.x, samples.y,
                   [&](double at) { return std::exp(rate * (at - origin) / range); });
  };
  // Coarse scan over factors e^-20 ... e^20 across the range of x, then golden section around the
  // best one.
  constexpr double scan_step = 0.25;
  constexpr int scan_half = 80;
  int best = -scan_half;
  double least = projected(scan_step * best).residual;
  for (int k = -scan_half + 1; k <= scan_half; ++k) {
    const double residual = projected(scan_step * k).residual;
    if (residual < least) {
      least = residual;
      best = k;
    }
  }
  const double rate = golden_section([&](double r) { return projected(r).residual; },
                                     scan_step * (best - 1), scan_step * (best + 1));
  // back from pure numbers to the units of x
  const Projection found = projected(rate);
  fit.rate = rate / range;
  fit.amplitude = found.amplitude * std::exp(-fit.rate * origin);
  fit.r2 = determination(found.residual, total_squares(samples.y));
  return fit;
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
    // weights that fall on no sample are missing from both sums: the mean stays a mean
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

Statistics statistics(std::span<const double> values) {
  Statistics result;
  double sum = 0.0;
  for (double value : values) {
    if (!std::isfinite(value)) continue;
    sum += value;
    result.min = result.samples ? std::min(result.min, value) : value;
    result.max = result.samples ? std::max(result.max, value) : value;
    ++result.samples;
  }
  if (result.samples) result.mean = sum / static_cast<double>(result.samples);
  return result;
}

double quantile_of_sorted(std::span<const double> sorted, double p) {
  if (sorted.empty()) return not_known;
  // By rank: p = 0 is the least, p = 1 the largest, and linear between two that follow each other.
  const double at = p * static_cast<double>(sorted.size() - 1);
  const size_t below = static_cast<size_t>(at), above = std::min(below + 1, sorted.size() - 1);
  return sorted[below] + (at - static_cast<double>(below)) * (sorted[above] - sorted[below]);
}

double quantile(std::span<const double> values, double p) {
  std::vector<double> sorted;
  for (double value : values)
    if (std::isfinite(value)) sorted.push_back(value);
  std::sort(sorted.begin(), sorted.end());
  return quantile_of_sorted(sorted, p);
}

}  // namespace ballast
