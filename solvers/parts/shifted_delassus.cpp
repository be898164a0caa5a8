#include "solvers/parts/shifted_delassus.hpp"

namespace ballast {

template <typename Visit>
void ShiftedDelassus::for_block_entries(const std::vector<Eigen::Matrix3d>& blocks,
                                        const Visit& visit) const {
  const FrictionProblem& problem = w_->problem();
  for (int c = 0; c < problem.contact_count(); ++c)
    for (int j = 0; j < problem.contact_rows(c); ++j)
      for (int i = 0; i < problem.contact_rows(c); ++i)
        visit(problem.row_begin[c] + i, problem.row_begin[c] + j, blocks[c](i, j));
}

void ShiftedDelassus::prepare(ContactOperator& w) {
  w_ = &w;
  const FrictionProblem& problem = w.problem();
  dynamics_ = problem.has_dynamics;
  symmetric_ = true;
  if (dynamics_) {
    base_ = sparse_mass(problem.dynamics);
    h_ = sparse_h(problem);
    h_transposed_ = h_.transpose();
    return;
  }
  // A stored W may be unsymmetric by some per cent: then LU in place of Cholesky.
  base_ = problem.delassus.w;
  const SparseColumns transposed = base_.transpose();
  symmetric_ = (base_ - transposed).norm() <= 1e-14 * base_.norm();
}

bool ShiftedDelassus::factor(const std::vector<Eigen::Matrix3d>& shift,
                             const std::vector<Eigen::Matrix3d>& sigma) {
  shift_ = shift;
  sigma_ = sigma;
  // The block diagonal as a sparse matrix: Sigma on the bodies, P on W.
  std::vector<Eigen::Triplet<double>> entries;
  for_block_entries(dynamics_ ? sigma_ : shift_,
                    [&](int i, int j, double x) { entries.emplace_back(i, j, x); });
  SparseColumns blocks(w_->problem().row_count(), w_->problem().row_count());
  blocks.setFromTriplets(entries.begin(), entries.end());
  // M + H^T Sigma H couples bodies that touch, W + P contacts that share a body.
  if (dynamics_) {
    const SparseColumns scaled = blocks * h_;
    const SparseColumns product = h_transposed_ * scaled;
    matrix_ = base_ + product;
  } else {
    matrix_ = base_ + blocks;
  }
  matrix_.makeCompressed();
  return symmetric_ ? cholesky_.factor(matrix_) : lu_.factor(matrix_);
}

void ShiftedDelassus::solve_once(const Eigen::VectorXd& b, Eigen::VectorXd& x) {
  if (!dynamics_) {
    if (symmetric_)
      cholesky_.solve(b, x);
    else
      lu_.solve(matrix_, b, x);
    return;
  }
  // Woodbury: x = Sigma (b - H (M + H^T Sigma H)^-1 H^T Sigma b).
  const FrictionProblem& problem = w_->problem();
  scaled_.resize(b.size());
  for (int c = 0; c < problem.contact_count(); ++c) w_->put(scaled_, c, sigma_[c] * w_->at(b, c));
  contact_to_body_impulse(problem.dynamics, problem.row_begin, scaled_, body_);
  cholesky_.solve(body_, body_);
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
