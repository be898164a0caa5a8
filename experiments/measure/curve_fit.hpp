#pragma once
// Least squares and smoothing of measured curves. Everything skips samples that are not finite.

#include <limits>
#include <span>
#include <vector>

namespace ballast {

inline constexpr double not_known = std::numeric_limits<double>::quiet_NaN();

/// y = offset + slope x, ordinary least squares in y.
struct LineFit {
  double offset = not_known, slope = not_known;
  double slope_error =
      not_known;          ///< standard error of the slope, from the residuals (needs 3 samples)
  double r2 = not_known;  ///< 1 - SS_residual / SS_total; NaN when y is constant
  int samples = 0;
  double at(double x) const { return offset + slope * x; }
};

/// y = amplitude exp(rate x), least squares in y itself (not in log y, which would weight the small
/// values and cannot take zeros). R^2 is in y as well, so it compares with a LineFit's.
struct ExponentialFit {
  double amplitude = not_known, rate = not_known;
  double r2 = not_known;
  int samples = 0;
  double at(double x) const;
};

/// NaN where there are fewer than two different x.
LineFit fit_line(std::span<const double> x, std::span<const double> y);
ExponentialFit fit_exponential(std::span<const double> x, std::span<const double> y);

/// y = amplitude shape(x) for a shape that has no parameter left: its best amplitude, and the
/// squared residuals about it. What a shape with one more parameter is fitted by: the least
/// residual over that parameter. Everything must be finite.
struct Projection {
  double amplitude = not_known, residual = not_known;
};
template <class Shape>
Projection project(std::span<const double> x, std::span<const double> y, const Shape& shape) {
  double sy = 0.0, ss = 0.0;
  for (size_t k = 0; k < x.size(); ++k) {
    const double s = shape(x[k]);
    sy += s * y[k];
    ss += s * s;
  }
  Projection result{sy / ss, 0.0};
  for (size_t k = 0; k < x.size(); ++k) {
    const double miss = y[k] - result.amplitude * shape(x[k]);
    result.residual += miss * miss;
  }
  return result;
}

/// Centred low-pass without phase shift: Hann-weighted mean over `width` samples to both sides
/// together (an odd number is made of it), weights cut and renormalised at the ends and where
/// samples are not finite. NaN stays NaN. width <= 1: a copy.
std::vector<double> low_pass(std::span<const double> y, int width);

/// Mean, least and largest of the finite samples.
struct Statistics {
  double mean = not_known, min = not_known, max = not_known;
  long samples = 0;
};
Statistics statistics(std::span<const double> values);

/// The value that the share `p` (0 <= p <= 1) of the samples does not exceed, linear between the
/// two nearest of `sorted`, which grows: 0.5 is the median, the mean of the middle two of an even
/// number. NaN without samples.
double quantile_of_sorted(std::span<const double> sorted, double p);

/// The same of values in any order; those that are not finite are left out.
double quantile(std::span<const double> values, double p);

}  // namespace ballast
