#pragma once
// What a referee asks of a fit: an interval. Sample means with standard errors, power laws, lines
// through the origin, Eq. 5.

#include <span>
#include <string>
#include <vector>

#include "experiments/measure/significance.hpp"

namespace ballast {

/// Mean over independent samples (seeds) with its standard error s/sqrt(n); NaN error for one
/// sample. Skips what is not finite.
struct SampleMean {
  double mean = not_known, error = not_known;
  int samples = 0;
};
SampleMean sample_mean(std::span<const double> values);

/// y = prefactor x^exponent by least squares of log y on log x: every point weighs the same,
/// whatever its size.
struct PowerFit {
  double exponent = not_known, prefactor = not_known;
  double half_width = not_known;  ///< of the exponent's 95 % confidence interval (needs 3 points)
  double r2 = not_known;          ///< of the logarithms
  int samples = 0;
  double at(double x) const;
};
/// Points that are not finite and positive are left out.
PowerFit fit_power(std::span<const double> x, std::span<const double> y);

/// Is a fitted power law consistent with the scatter of the samples? chi^2 over its degrees of
/// freedom (points - 2): squared residuals of the logarithms in units of the points' squared
/// relative standard errors. About 1: yes; much more: the points leave the law by more than their
/// errors, and the interval of the exponent says how well a line can be drawn, not how well it
/// holds. The errors are pooled over the points, because an error from three samples is itself
/// known to a factor of two. NaN with fewer than three points that have errors.
double reduced_chi2(const PowerFit& fit, std::span<const double> x, std::span<const double> y,
                    std::span<const double> error);

/// y = C x, C the geometric mean of y/x; its 95 % interval is a factor because the points span
/// decades.
struct Proportion {
  double factor = not_known;
  double low = not_known, high = not_known;  ///< 95 % interval of the mean
  double spread = not_known;  ///< exp of the standard deviation of log(y/x): typical factor between
                              ///< a point and the line
  int samples = 0;
};
Proportion fit_proportion(std::span<const double> x, std::span<const double> y);

/// Paper, Eq. 5: rate = D nu below nu_c, D nu_c^2 / nu above. D = Delta rho_max / rho_0.
struct PeakedRate {
  double gain = not_known;                   ///< D
  double critical = not_known;               ///< nu_c [Hz]
  double low = not_known, high = not_known;  ///< 95 % interval of nu_c from the profile of the
                                             ///< squared residuals; at an end of the data: that end
  double r2 = not_known;
  int samples = 0;
  double at(double frequency) const;
};
/// Least squares in the rate itself; nu_c is sought within the frequencies given. `gain`: D where
/// it is known, so that nu_c alone is fitted as in the paper. Needs three points.
PeakedRate fit_peaked_rate(std::span<const double> frequency, std::span<const double> rate,
                           double gain = not_known);

}  // namespace ballast
