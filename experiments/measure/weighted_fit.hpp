#pragma once
// Least squares of any linear law with points of unequal errors.

#include <Eigen/Core>

#include "experiments/measure/curve_fit.hpp"

namespace ballast {

/// y = design * value. A misfit is measured in the points' own errors.
struct WeightedFit {
  Eigen::VectorXd value;
  Eigen::MatrixXd covariance;  ///< of the values, from the points' errors
  double chi2 = not_known;     ///< squared misses in units of the squared errors
  int degrees_of_freedom = 0;  ///< points less values

  double reduced() const { return chi2 / degrees_of_freedom; }
  /// A linear combination of the values, with its standard error.
  double at(const Eigen::VectorXd& row) const { return row.dot(value); }
  double error_at(const Eigen::VectorXd& row) const;
};

/// `error`: the standard error of each y, positive. Needs as many points as values.
WeightedFit fit_weighted(const Eigen::MatrixXd& design, const Eigen::VectorXd& y,
                         const Eigen::VectorXd& error);

/// F and its p: does `more`, which has further values, fit better than `less` by more than chance?
/// The scale of the errors is taken from `more`'s own misses.
struct Improvement {
  double ratio = not_known, p = not_known;
};
Improvement improvement(const WeightedFit& less, const WeightedFit& more);

}  // namespace ballast
