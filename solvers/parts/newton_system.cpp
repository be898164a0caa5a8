#include "solvers/parts/newton_system.hpp"

#include <Eigen/LU>

namespace ballast {

/// Solves the contacts with df_du = 0 and lists the others.
bool NewtonSystem::solve_idle(const std::vector<ContactLinearisation>& linear, Impulses& dr) {
  const FrictionProblem& problem = w_->problem();
  pressed_.clear();
  pressed_rows_ = 0;
  pressed_entries_ = 0;
  place_.resize(problem.row_count());
  dr.resize(problem.row_count());
  for (int c = 0; c < problem.contact_count(); ++c) {
    const ContactLinearisation& l = linear[c];
    const int first = problem.row_begin[c], rows = problem.contact_rows(c);
    if (!l.df_dr.allFinite() || !l.f.allFinite()) return false;
    const bool is_pressed = rows == 3 ? !l.df_du.isZero(0.0) : l.df_du(0, 0) != 0.0;
    for (int i = 0; i < rows; ++i) place_[first + i] = is_pressed ? pressed_rows_ + i : -1;
    if (is_pressed) {
      pressed_.push_back(c);
      pressed_rows_ += rows;
      pressed_entries_ += problem.delassus.w.middleRows(first, rows).nonZeros();
    } else if (rows == 3) {
      dr.segment<3>(first) = -(l.df_dr.inverse() * l.f);
    } else {
      dr[first] = -l.f[0] / l.df_dr(0, 0);
    }
    if (!is_pressed && !dr.segment(first, rows).allFinite()) return false;
  }
  return true;
}

bool NewtonSystem::solve_dense(const std::vector<ContactLinearisation>& linear, Impulses& dr) {
  const FrictionProblem& problem = w_->problem();
  Eigen::MatrixXd matrix = Eigen::MatrixXd::Zero(pressed_rows_, pressed_rows_);
  Eigen::VectorXd right(pressed_rows_);
  for (const int c : pressed_) {
    const int first = problem.row_begin[c], rows = problem.contact_rows(c), at = place_[first];
    right.segment(at, rows) = -linear[c].f.head(rows);
    const auto df_du = linear[c].df_du.topLeftCorner(rows, rows);
    for (int i = 0; i < rows; ++i)
      for (SparseRows::InnerIterator w(problem.delassus.w, first + i); w; ++w)
        // The dr of an idle contact is known already and goes to the right-hand side.
        if (place_[w.col()] < 0)
          right.segment(at, rows) -= df_du.col(i) * (w.value() * dr[w.col()]);
        else
          matrix.col(place_[w.col()]).segment(at, rows) += df_du.col(i) * w.value();
    matrix.block(at, at, rows, rows) += linear[c].df_dr.topLeftCorner(rows, rows);
  }
  const Eigen::VectorXd solution = matrix.partialPivLu().solve(right);  // NaN where singular
  if (!solution.allFinite()) return false;
  for (int row = 0; row < problem.row_count(); ++row)
    if (place_[row] >= 0) dr[row] = solution[place_[row]];
  return true;
}

/// Solves for all contacts, so that the pattern stays and is ordered once; idle ones have B alone
/// in their rows.
bool NewtonSystem::solve_sparse(const std::vector<ContactLinearisation>& linear, Impulses& dr) {
  const FrictionProblem& problem = w_->problem();
  const int all_rows = problem.row_count();
  std::vector<Eigen::Triplet<double>> gains, own;
  Eigen::VectorXd right(all_rows);
  for (int c = 0; c < problem.contact_count(); ++c) {
    const int first = problem.row_begin[c], rows = problem.contact_rows(c);
    right.segment(first, rows) = -linear[c].f.head(rows);
    for (int i = 0; i < rows; ++i)
      for (int j = 0; j < rows; ++j) {
        gains.emplace_back(first + i, first + j, linear[c].df_du(i, j));
        own.emplace_back(first + i, first + j, linear[c].df_dr(i, j));
      }
  }
  // Zeros among the triplets stay entries.
  SparseColumns gain(all_rows, all_rows), diagonal(all_rows, all_rows);
  gain.setFromTriplets(gains.begin(), gains.end());
  diagonal.setFromTriplets(own.begin(), own.end());
  const SparseColumns matrix = SparseColumns(gain * SparseColumns(problem.delassus.w)) + diagonal;
  if (!sparse_lu_.factor(matrix)) return false;
  sparse_lu_.solve(right, dr);
  return dr.allFinite();
}

void NewtonSystem::prepare(const ContactOperator& w) {
  w_ = &w;
  if (w.problem().has_dynamics) matrix_.prepare(w.problem());
}

bool NewtonSystem::solve_bodies(const std::vector<ContactLinearisation>& linear, Impulses& dr) {
  const FrictionProblem& problem = w_->problem();
  gain_.resize(linear.size());
  dr.resize(problem.row_count());
  for (int c = 0; c < problem.contact_count(); ++c) {
    const Eigen::Matrix3d inverse = linear[c].df_dr.inverse();
    const Eigen::Vector3d source = inverse * linear[c].f;
    gain_[c] = inverse * linear[c].df_du;
    if (problem.contact_rows(c) == 1)
      gain_[c] = Eigen::Vector3d(gain_[c](0, 0), 0.0, 0.0).asDiagonal();
    if (!source.allFinite() || !gain_[c].allFinite()) return false;
    w_->put(dr, c, -source);
  }
  return solve_springs(gain_, dr, u_);
}

bool NewtonSystem::solve_springs(const std::vector<Eigen::Matrix3d>& gain, Impulses& dr,
                                 Eigen::VectorXd& du, double enough) {
  const FrictionProblem& problem = w_->problem();
  contact_to_body_impulse(problem.dynamics, problem.row_begin, dr, right_);
  if (!matrix_.solve(gain, right_, dv_, enough)) return false;
  body_to_contact_velocity(problem.dynamics, problem.row_begin, dv_, du);
  // body_to_contact_velocity() adds the bias, which is no part of a change of velocity.
  du -= problem.dynamics.bias;
  for (int c = 0; c < problem.contact_count(); ++c)
    w_->put(dr, c, w_->at(dr, c) - gain[c] * w_->at(du, c));
  return true;
}

bool NewtonSystem::solve(const std::vector<ContactLinearisation>& linear, Impulses& dr) {
  if (w_->problem().has_dynamics) return solve_bodies(linear, dr);
  if (!solve_idle(linear, dr)) return false;
  if (pressed_.empty()) return true;
  // With few rows a dense factorisation is faster than looking for zeros; with more it is so where
  // this share of the square is filled.
  constexpr int few_rows = 160, most_dense_rows = 600;
  constexpr double nearly_full = 0.3;
  const double square = static_cast<double>(pressed_rows_) * pressed_rows_;
  const bool is_full = static_cast<double>(pressed_entries_) > nearly_full * square;
  const bool is_dense = pressed_rows_ <= few_rows || (is_full && pressed_rows_ <= most_dense_rows);
  return is_dense ? solve_dense(linear, dr) : solve_sparse(linear, dr);
}

}  // namespace ballast
