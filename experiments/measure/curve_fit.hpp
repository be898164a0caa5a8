#pragma once
// Fits of measured curves, and statistics to judge them: confidence intervals, whether a law holds,
// whether a difference is more than the scatter of the samples. All functions skip values that are
// not finite, and return NaN where there are too few samples or there is no degree of freedom.

#include <Eigen/Core>
#include <cmath>
#include <functional>
#include <limits>
#include <span>
#include <vector>

namespace ballast {

inline constexpr double not_known = std::numeric_limits<double>::quiet_NaN();

/// A number of each element: a member, or what a function makes of it.
template <class Range, class Number>
std::vector<double> values_of(const Range& range, const Number& number) {
  std::vector<double> values;
  for (const auto& element : range) values.push_back(std::invoke(number, element));
  return values;
}

/// Mean, least and largest of the finite samples.
struct Statistics {
  double mean = not_known, min = not_known, max = not_known;
  long samples = 0;
};
Statistics statistics(std::span<const double> values);

/// The quantile `p` (0 <= p <= 1) of the samples, linear between the two nearest: 0.5 is the
/// median, which is the mean of the middle two of an even number of samples. NaN without samples.
double quantile(std::span<const double> values, double p);

/// Centred low-pass without phase shift: the Hann-weighted mean over a window of `width` samples
/// (an even width becomes odd). Weights are cut and renormalised at the ends and where samples are
/// not finite. NaN stays NaN. width <= 1: a copy.
std::vector<double> low_pass(std::span<const double> y, int width);

/// y = offset + slope x, ordinary least squares in y.
struct LineFit {
  double offset = not_known, slope = not_known;
  double slope_error = not_known;  ///< standard error, from the residuals (needs 3 samples)
  double r2 = not_known;           ///< 1 - SS_residual / SS_total; NaN when y is constant
  int samples = 0;
  double at(double x) const { return offset + slope * x; }
};
LineFit fit_line(std::span<const double> x, std::span<const double> y);

/// y = amplitude exp(rate x), least squares in y itself (not in log y, which would weight the small
/// values and cannot take zeros). R^2 is in y as well, so it can be compared with that of a
/// LineFit.
struct ExponentialFit {
  double amplitude = not_known, rate = not_known;
  double r2 = not_known;
  double at(double x) const { return amplitude * std::exp(rate * x); }
};
ExponentialFit fit_exponential(std::span<const double> x, std::span<const double> y);

/// Probability that Student's t with this many degrees of freedom is at least |t| away from 0.
double t_test_p(double t, double degrees_of_freedom);
/// Two-sided 95 % quantile of Student's t. Infinite without a degree of freedom.
double student_t95(int degrees_of_freedom);
/// Probability that a ratio of variances is at least this large by chance: F distribution with
/// these degrees of freedom above and below. For unbounded `below` it is that of chi^2/above.
double f_test_p(double ratio, double above, double below);
/// Holm's correction of the p of tests that are asked together, in the order given. It bounds the
/// probability that any of them is small by chance.
std::vector<double> holm(std::span<const double> p);

/// Mean over independent samples (seeds) with its standard error s/sqrt(n); NaN error for one
/// sample.
struct SampleMean {
  double mean = not_known, error = not_known;
  int samples = 0;
  /// The half width of the 95 % confidence interval.
  double half_width() const { return student_t95(samples - 1) * error; }
  /// The probability of a mean at least so far from zero where the true mean is zero.
  double p() const { return t_test_p(mean / error, samples - 1); }
  /// Standard deviation of one sample.
  double deviation() const { return error * std::sqrt(static_cast<double>(samples)); }
};
SampleMean sample_mean(std::span<const double> values);

/// Standard deviation of one sample, pooled over several groups of samples that scatter alike about
/// their own means. It is more accurate than that of a single group.
struct PooledError {
  double deviation = not_known;
  int degrees_of_freedom = 0;  ///< samples minus groups
};
PooledError pooled_error(std::span<const std::vector<double>> groups);

/// A ratio of two variances, and the probability of so large a ratio by chance.
struct VarianceRatio {
  double ratio = not_known, p = not_known;
};
/// Tests whether groups differ by more than their samples scatter, each sample's own mean being
/// taken out. Every sample is measured in every group (value s of each group is sample s). Returns
/// F and its p; NaN where a group lacks a sample.
VarianceRatio repeated_anova(std::span<const std::vector<double>> groups);

/// Measured points: means over samples.
struct Points {
  std::vector<double> x, y;
  std::vector<double> error;  ///< standard errors of y
  int error_dof = 0;          ///< degrees of freedom of all errors together: samples minus points

  void add(double at, const SampleMean& mean);
};

/// y = prefactor x^exponent by least squares of log y on log x: every point weighs the same,
/// whatever its size.
struct PowerFit {
  double exponent = not_known, prefactor = not_known;
  double half_width = not_known;  ///< of the exponent's 95 % confidence interval (needs 3 points)
  double r2 = not_known;          ///< of the logarithms
  int samples = 0;
  double at(double x) const { return prefactor * std::pow(x, exponent); }
};
/// Points that are not finite and positive are left out.
PowerFit fit_power(std::span<const double> x, std::span<const double> y);

/// The misfit of the power law to the points that have errors: chi^2 of the logarithms, in units of
/// the relative standard errors, over its degrees of freedom, and the p of so large a misfit where
/// the law holds. Far above 1 the interval of the exponent says how well a line can be drawn, not
/// how well it holds. The errors are pooled over the points, because an error from three samples is
/// itself known to a factor of two. NaN with fewer than three such points.
VarianceRatio misfit_of(const Points& points);

/// y = C x, where C is the geometric mean of y/x. Its 95 % interval is a factor because the points
/// span decades.
struct Proportion {
  double factor = not_known;
  double low = not_known, high = not_known;  ///< 95 % interval of the mean
  double spread = not_known;  ///< typical factor between a point and the line: exp of the standard
                              ///< deviation of log(y/x)
};
Proportion fit_proportion(std::span<const double> x, std::span<const double> y);

/// Paper, Eq. 5: rate = D nu below nu_c, D nu_c^2 / nu above. D = Delta rho_max / rho_0.
struct PeakedRate {
  double gain = not_known;                   ///< D
  double critical = not_known;               ///< nu_c [Hz]
  double low = not_known, high = not_known;  ///< 95 % interval of nu_c from the profile of the
                                             ///< squared residuals; at an end of the data: that end
  double r2 = not_known;
  double at(double frequency) const;
};
/// Least squares in the rate itself; nu_c is sought within the frequencies given. `gain`: a known
/// D; then only nu_c is fitted, as in the paper. Needs three points.
PeakedRate fit_peaked_rate(std::span<const double> frequency, std::span<const double> rate,
                           double gain = not_known);

/// Least squares of y = design * value with points of unequal errors.
struct WeightedFit {
  Eigen::VectorXd value;
  Eigen::MatrixXd covariance;  ///< of the values, from the points' errors
  double chi2 = not_known;     ///< squared residuals in units of the squared errors
  int degrees_of_freedom = 0;  ///< points minus values

  double reduced_chi2() const { return chi2 / degrees_of_freedom; }
  /// A linear combination of the values, with its standard error.
  double at(const Eigen::VectorXd& row) const { return row.dot(value); }
  double error_at(const Eigen::VectorXd& row) const { return std::sqrt(row.dot(covariance * row)); }
};
/// `error`: the standard error of each y, positive. Needs as many points as values.
WeightedFit fit_weighted(const Eigen::MatrixXd& design, const Eigen::VectorXd& y,
                         const Eigen::VectorXd& error);

/// F and its p, for the test whether `more`, which has further values, fits better than `less` by
/// more than chance. The scale of the errors is taken from the residuals of `more`.
VarianceRatio improvement(const WeightedFit& less, const WeightedFit& more);

}  // namespace ballast
