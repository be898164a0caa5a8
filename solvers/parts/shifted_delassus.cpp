#include "solvers/parts/shifted_delassus.hpp"

namespace ballast {

void ShiftedDelassus::prepare(ContactOperator& w) {
  w_ = &w;
  const FrictionProblem& problem = w.problem();
  dynamics_ = problem.has_dynamics;
  if (dynamics_) {
    h_ = sparse_h(problem);
    return bodies_.prepare(problem);
  }
  // A stored W may be unsymmetric by some per cent: then LU in place of Cholesky.
  stored_ = problem.delassus.w;
  const SparseColumns transposed = stored_.transpose();
  symmetric_ = (stored_ - transposed).norm() <= 1e-14 * stored_.norm();
}

bool ShiftedDelassus::factor(const std::vector<Eigen::Matrix3d>& shift,
                             const std::vector<Eigen::Matrix3d>& sigma) {
  shift_ = shift;
  sigma_ = sigma;
  if (dynamics_) return bodies_.factor(sigma_);
  sum_ = stored_;
  const FrictionProblem& problem = w_->problem();
  for (int c = 0; c < problem.contact_count(); ++c)
    for (int j = 0; j < problem.contact_rows(c); ++j)
      for (int i = 0; i < problem.contact_rows(c); ++i)
        sum_.coeffRef(problem.row_begin[c] + i, problem.row_begin[c] + j) += shift_[c](i, j);
  sum_.makeCompressed();
  return symmetric_ ? cholesky_.factor(sum_) : lu_.factor(sum_);
}

void ShiftedDelassus::solve_once(const Eigen::VectorXd& b, Eigen::VectorXd& x) {
  if (!dynamics_) {
    if (symmetric_)
      cholesky_.solve(b, x);
    else
      lu_.solve(sum_, b, x);
    return;
  }
  // Woodbury: x = Sigma (b - H (M + H^T Sigma H)^-1 H^T Sigma b).
  const FrictionProblem& problem = w_->problem();
  scaled_.resize(b.size());
  for (int c = 0; c < problem.contact_count(); ++c) w_->put(scaled_, c, sigma_[c] * w_->at(b, c));
  contact_to_body_impulse(problem.dynamics, problem.row_begin, scaled_, body_);
  bodies_.solve_once(body_, body_);
  contact_ = b;
  contact_.noalias() -= h_ * body_;
  x.resize(b.size());
  for (int c = 0; c < problem.contact_count(); ++c) w_->put(x, c, sigma_[c] * w_->at(contact_, c));
}

void ShiftedDelassus::solve(const Eigen::VectorXd& b, Eigen::VectorXd& x, int refinements) {
  solve_once(b, x);
  // What (W + P) x lacks of b is solved for with the same factor: each turn takes off most of the
  // rounding that P's wide range has caused.
  for (int k = 0; k < refinements; ++k) {
    residual_.resize(b.size());
    w_->multiply(x, residual_);
    for (int c = 0; c < w_->contact_count(); ++c)
      w_->put(residual_, c, w_->at(b, c) - w_->at(residual_, c) - shift_[c] * w_->at(x, c));
    solve_once(residual_, correction_);
    x += correction_;
  }
}

}  // namespace ballast
