#include "experiments/measure/weighted_fit.hpp"

#include <Eigen/Cholesky>
#include <cmath>

#include "experiments/measure/significance.hpp"

namespace ballast {

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
