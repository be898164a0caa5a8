#include "solvers/parts/body_matrix.hpp"

#include <algorithm>

#include "solvers/parts/bodies_in_contact.hpp"

namespace ballast {
namespace {

/// |b - A x| over |b|, above which an LU without exchanged rows is not trusted.
constexpr double most_rest = 1e-8;

int body_of(const DynamicsForm& d, int c, int side) {
  return side == 0 ? d.body_a[c] : d.body_b[c];
}

/// H of contact c with respect to the body of one side: column-major, rows x dofs.
const double* side_block(const FrictionProblem& problem, int c, int side) {
  const DynamicsForm& d = problem.dynamics;
  const double* h = d.h.data() + d.h_begin[c];
  return side == 0 ? h : h + problem.contact_rows(c) * d.body_dofs(d.body_a[c]);
}

}  // namespace

void BodyMatrix::prepare(const FrictionProblem& problem) {
  problem_ = &problem;
  const DynamicsForm& d = problem.dynamics;
  const std::vector<std::vector<int>> near =
      bodies_in_contact(d.body_count(), problem.contact_count(),
                        [&d](int c) { return std::pair(d.body_a[c], d.body_b[c]); });
  // A body's columns have the rows of all its neighbours.
  std::vector<int> height(d.body_count(), 0);
  int entries = 0;
  for (int b = 0; b < d.body_count(); ++b) {
    for (const int n : near[b]) height[b] += d.body_dofs(n);
    entries += height[b] * d.body_dofs(b);
  }
  matrix_.resize(d.dof_count(), d.dof_count());
  matrix_.resizeNonZeros(entries);
  int* outer = matrix_.outerIndexPtr();
  int* inner = matrix_.innerIndexPtr();
  int at = 0;
  for (int b = 0; b < d.body_count(); ++b)
    for (int k = 0; k < d.body_dofs(b); ++k) {
      outer[d.dof_begin[b] + k] = at;
      for (const int n : near[b])
        for (int i = 0; i < d.body_dofs(n); ++i) inner[at++] = d.dof_begin[n] + i;
    }
  outer[d.dof_count()] = at;
  place_blocks(near);
  fronts_.analyse(matrix_, d.dof_begin);
}

/// Where each contact's four blocks and each body's mass go.
void BodyMatrix::place_blocks(const std::vector<std::vector<int>>& near) {
  const DynamicsForm& d = problem_->dynamics;
  std::vector<std::vector<int>> first(near.size());  // of each neighbour's rows in a body's column
  for (size_t b = 0; b < near.size(); ++b) {
    int row = 0;
    for (const int n : near[b]) {
      first[b].push_back(row);
      row += d.body_dofs(n);
    }
  }
  const auto find = [&](int row_body, int column_body) {
    const auto& list = near[column_body];
    return first[column_body][std::lower_bound(list.begin(), list.end(), row_body) - list.begin()];
  };
  offset_.assign(problem_->contact_count(), {-1, -1, -1, -1});
  for (int c = 0; c < problem_->contact_count(); ++c)
    for (int p = 0; p < 2; ++p)
      for (int q = 0; q < 2; ++q) {
        const int row = body_of(d, c, p), column = body_of(d, c, q);
        if (row >= 0 && column >= 0) offset_[c][2 * p + q] = find(row, column);
      }
  mass_offset_.resize(d.body_count());
  for (int b = 0; b < d.body_count(); ++b) mass_offset_[b] = find(b, b);
}

/// Adds H_p^T E H_q of contact c with its sides p and q (0, 1).
void BodyMatrix::add_block(int c, int p, int q, const Eigen::Matrix3d& e) {
  const DynamicsForm& d = problem_->dynamics;
  const int offset = offset_[c][2 * p + q];
  if (offset < 0) return;
  const int rows = problem_->contact_rows(c);
  const int left = body_of(d, c, p), right = body_of(d, c, q);
  const int left_dofs = d.body_dofs(left), right_dofs = d.body_dofs(right);
  const double* hp = side_block(*problem_, c, p);
  const double* hq = side_block(*problem_, c, q);
  const int* outer = matrix_.outerIndexPtr();
  // Column by column: E times a column of H_q, then H_p^T times that.
  for (int j = 0; j < right_dofs; ++j) {
    double eh[3] = {0.0, 0.0, 0.0};
    for (int i = 0; i < rows; ++i)
      for (int k = 0; k < rows; ++k) eh[i] += e(i, k) * hq[j * rows + k];
    double* column = matrix_.valuePtr() + outer[d.dof_begin[right] + j] + offset;
    for (int i = 0; i < left_dofs; ++i)
      for (int k = 0; k < rows; ++k) column[i] += hp[i * rows + k] * eh[k];
  }
}

void BodyMatrix::fill(const std::vector<Eigen::Matrix3d>& gain) {
  const DynamicsForm& d = problem_->dynamics;
  std::fill_n(matrix_.valuePtr(), matrix_.nonZeros(), 0.0);
  // The masses.
  for (int b = 0; b < d.body_count(); ++b) {
    const int n = d.body_dofs(b);
    const double* mass = d.mass.data() + d.mass_begin[b];
    for (int j = 0; j < n; ++j) {
      double* column =
          matrix_.valuePtr() + matrix_.outerIndexPtr()[d.dof_begin[b] + j] + mass_offset_[b];
      for (int i = 0; i < n; ++i) column[i] = mass[j * n + i];
    }
  }
  for (int c = 0; c < problem_->contact_count(); ++c)
    for (int p = 0; p < 2; ++p)
      for (int q = 0; q < 2; ++q) add_block(c, p, q, gain[c]);
}

bool BodyMatrix::factor(const std::vector<Eigen::Matrix3d>& gain) {
  fill(gain);
  return fronts_.factor(matrix_);
}

bool BodyMatrix::solve(const std::vector<Eigen::Matrix3d>& gain, const Eigen::VectorXd& b,
                       Eigen::VectorXd& x) {
  if (factor(gain)) {
    fronts_.solve(b, x);
    // Refined once, as the other way is.
    rest_ = b;
    rest_.noalias() -= matrix_ * x;
    fronts_.solve(rest_, correction_);
    x += correction_;
    rest_.noalias() -= matrix_ * correction_;
    if (rest_.norm() <= most_rest * b.norm()) return true;
  }
  if (!exchanging_.factor(matrix_)) return false;
  exchanging_.solve(matrix_, b, x, 1);
  return x.allFinite();
}

}  // namespace ballast
