#include "solvers/parts/shifted_delassus.hpp"

namespace ballast {

void ShiftedDelassus::prepare(ContactOperator& w) {
  w_ = &w;
  const FrictionProblem& problem = w.problem();
  shift.resize(problem.contact_count());
  sigma.resize(problem.contact_count());
  if (problem.has_dynamics) {
    h_ = sparse_h(problem);
    return bodies_.prepare(problem);
  }
  stored_ = problem.delassus.w;
}

bool ShiftedDelassus::factor() {
  const FrictionProblem& problem = w_->problem();
  if (problem.has_dynamics) return bodies_.factor(sigma);
  SparseColumns sum = stored_;
  for (int c = 0; c < problem.contact_count(); ++c)
    for (int j = 0; j < problem.contact_rows(c); ++j)
      for (int i = 0; i < problem.contact_rows(c); ++i)
        sum.coeffRef(problem.row_begin[c] + i, problem.row_begin[c] + j) += shift[c](i, j);
  sum.makeCompressed();
  sum_.analyse(sum, problem.row_begin);
  return sum_.factor(sum);
}

void ShiftedDelassus::solve_once(const Eigen::VectorXd& b, Eigen::VectorXd& x) {
  const FrictionProblem& problem = w_->problem();
  if (!problem.has_dynamics) return sum_.solve(b, x);
  // Woodbury: x = Sigma (b - H (M + H^T Sigma H)^-1 H^T Sigma b).
  scaled_.resize(b.size());
  for (int c = 0; c < problem.contact_count(); ++c) w_->put(scaled_, c, sigma[c] * w_->at(b, c));
  contact_to_body_impulse(problem.dynamics, problem.row_begin, scaled_, body_);
  bodies_.solve_once(body_, body_);
  contact_ = b;
  contact_.noalias() -= h_ * body_;
  x.resize(b.size());
  for (int c = 0; c < problem.contact_count(); ++c) w_->put(x, c, sigma[c] * w_->at(contact_, c));
}

void ShiftedDelassus::solve(const Eigen::VectorXd& b, Eigen::VectorXd& x, int refinements) {
  solve_once(b, x);
  // Solves for the residual b - (W + P) x with the same factor: each turn removes most of the
  // rounding that P's wide range has caused.
  for (int k = 0; k < refinements; ++k) {
    residual_.resize(b.size());
    w_->multiply(x, residual_);
    for (int c = 0; c < w_->contact_count(); ++c)
      w_->put(residual_, c, w_->at(b, c) - w_->at(residual_, c) - shift[c] * w_->at(x, c));
    solve_once(residual_, correction_);
    x += correction_;
  }
}

}  // namespace ballast
