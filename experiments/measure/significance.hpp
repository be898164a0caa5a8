#pragma once
// Is a difference more than the scatter of the samples? Student's t, the F distribution, pooled
// errors, and the correction for asking many questions at once. Everything skips what is not
// finite, and answers NaN where there is no degree of freedom.

#include <span>
#include <vector>

#include "experiments/measure/curve_fit.hpp"

namespace ballast {

/// Probability that Student's t with this many degrees of freedom is at least |t| away from 0.
double student_p(double t, double degrees_of_freedom);

/// Two-sided 95 % quantile of Student's t. Infinite without a degree of freedom.
double student_t95(int degrees_of_freedom);

/// Probability that a ratio of variances is at least this large by chance: F with these degrees of
/// freedom above and below. With `below` unbounded it is that of chi^2/above.
double f_p(double ratio, double above, double below);

/// Holm's correction: each p as it must be read when all were asked together. Bounds the
/// probability that any of them is small by chance. In the order given.
std::vector<double> holm(std::span<const double> p);

/// Standard deviation of one sample, from several groups of samples that scatter alike about means
/// of their own: known better than from any one of them.
struct PooledError {
  double deviation = not_known;
  int degrees_of_freedom = 0;  ///< samples less groups
};
PooledError pooled_error(std::span<const std::vector<double>> groups);

/// A difference with its standard error.
struct Difference {
  double mean = not_known, error = not_known;
  int degrees_of_freedom = 0;
  double p() const;           ///< of a difference so large where there is none
  double half_width() const;  ///< of the 95 % confidence interval
};

/// Mean of b[k] - a[k]: what a pair has in common (the same packing) drops out.
Difference paired_difference(std::span<const double> a, std::span<const double> b);

}  // namespace ballast
