#include "solvers/parts/body_matrix.hpp"

#include <algorithm>

namespace ballast {
namespace {

/// |b - A x| over |b|, above which an LU without exchanged rows is not trusted.
constexpr double most_rest = 1e-8;

/// For each body, the bodies that it touches and the body itself, ascending.
std::vector<std::vector<int>> bodies_in_contact(const DynamicsForm& d) {
  std::vector<std::vector<int>> near(d.body_count());
  for (int b = 0; b < d.body_count(); ++b) near[b].push_back(b);
  for (size_t c = 0; c < d.body_a.size(); ++c) {
    const int a = d.body_a[c], b = d.body_b[c];
    if (a < 0 || b < 0) continue;
    near[a].push_back(b);
    near[b].push_back(a);
  }
  for (std::vector<int>& list : near) {
    std::sort(list.begin(), list.end());
    list.erase(std::unique(list.begin(), list.end()), list.end());
  }
  return near;
}

/// sum += left^T E right, where columns of the sum are `height` entries apart. The compiler unrolls
/// it where it knows the sizes.
[[gnu::always_inline]] inline void add_product(const double* left, int left_dofs,
                                               const Eigen::Matrix3d& e, int rows,
                                               const double* right, int right_dofs, double* sum,
                                               int height) {
  // Column by column: E times a column of the right H, then the left H^T times that.
  for (int j = 0; j < right_dofs; ++j, right += rows, sum += height) {
    double eh[3] = {0.0, 0.0, 0.0};
    for (int i = 0; i < rows; ++i)
      for (int l = 0; l < rows; ++l) eh[i] += e(i, l) * right[l];
    for (int i = 0; i < left_dofs; ++i) {
      double entry = sum[i];
      for (int l = 0; l < rows; ++l) entry += left[i * rows + l] * eh[l];
      sum[i] = entry;
    }
  }
}

}  // namespace

/// The columns of a body have the rows of all bodies that it touches, and its own.
void BodyMatrix::prepare(const FrictionProblem& problem) {
  problem_ = &problem;
  const DynamicsForm& d = problem.dynamics;
  const std::vector<int>& dof_begin = d.dof_begin;
  std::vector<int> rows, inner, outer{0};
  const std::vector<std::vector<int>> near = bodies_in_contact(d);
  for (size_t b = 0; b < near.size(); ++b) {
    rows.clear();
    for (const int n : near[b])
      for (int i = dof_begin[n]; i < dof_begin[n + 1]; ++i) rows.push_back(i);
    for (int k = dof_begin[b]; k < dof_begin[b + 1]; ++k) {
      inner.insert(inner.end(), rows.begin(), rows.end());
      outer.push_back(static_cast<int>(inner.size()));
    }
  }
  matrix_.resize(dof_begin.back(), dof_begin.back());
  matrix_.resizeNonZeros(outer.back());
  std::copy(outer.begin(), outer.end(), matrix_.outerIndexPtr());
  std::copy(inner.begin(), inner.end(), matrix_.innerIndexPtr());
  const auto find = [&](int row_body, int column_body) -> Place {
    if (row_body < 0 || column_body < 0) return {0, 0};
    const int begin = outer[dof_begin[column_body]], end = outer[dof_begin[column_body] + 1];
    const auto row =
        std::lower_bound(inner.begin() + begin, inner.begin() + end, dof_begin[row_body]);
    return {static_cast<int>(row - inner.begin()), end - begin};
  };
  blocks_.resize(problem.contact_count());
  for (size_t c = 0; c < blocks_.size(); ++c) {
    const int a = d.body_a[c], b = d.body_b[c];
    blocks_[c] = {find(a, a), find(a, b), find(b, a), find(b, b)};
  }
  masses_.resize(near.size());
  for (int b = 0; b < static_cast<int>(near.size()); ++b) masses_[b] = find(b, b);
  fronts_.analyse(matrix_, dof_begin);
}

/// Adds H^T E H of one contact.
void BodyMatrix::add_contact(int c, const Eigen::Matrix3d& e) {
  const DynamicsForm& d = problem_->dynamics;
  const int rows = problem_->contact_rows(c);
  const int dofs[2] = {d.body_dofs(d.body_a[c]), d.body_dofs(d.body_b[c])};
  const double* first = d.h.data() + d.h_begin[c];  // column-major, rows x dofs
  const double* h[2] = {first, first + rows * dofs[0]};
  for (int k = 0; k < 4; ++k) {
    const auto [place, height] = blocks_[c][k];
    if (height == 0) continue;
    const int p = k / 2, q = k % 2;
    double* sum = matrix_.valuePtr() + place;
    if (rows == 3 && dofs[p] == 6 && dofs[q] == 6)
      add_product(h[p], 6, e, 3, h[q], 6, sum, height);
    else
      add_product(h[p], dofs[p], e, rows, h[q], dofs[q], sum, height);
  }
}

bool BodyMatrix::factor(const std::vector<Eigen::Matrix3d>& gain) {
  const DynamicsForm& d = problem_->dynamics;
  std::fill_n(matrix_.valuePtr(), matrix_.nonZeros(), 0.0);
  for (int b = 0; b < d.body_count(); ++b) {
    const int n = d.body_dofs(b);
    const double* mass = d.mass.data() + d.mass_begin[b];
    double* values = matrix_.valuePtr() + masses_[b].first;
    for (int j = 0; j < n; ++j) std::copy_n(mass + j * n, n, values + j * masses_[b].height);
  }
  for (int c = 0; c < problem_->contact_count(); ++c)
    if (!gain[c].isZero(0.0)) add_contact(c, gain[c]);
  return fronts_.factor(matrix_);
}

bool BodyMatrix::solve(const std::vector<Eigen::Matrix3d>& gain, const Eigen::VectorXd& b,
                       Eigen::VectorXd& x, double enough) {
  if (factor(gain)) {
    fronts_.solve(b, x);
    // Refined once, as LuFactor::solve() does.
    rest_ = b;
    rest_.noalias() -= matrix_ * x;
    if (rest_.norm() > enough * b.norm()) {
      fronts_.solve(rest_, correction_);
      x += correction_;
      rest_.noalias() -= matrix_ * correction_;
    }
    if (rest_.norm() <= most_rest * b.norm()) return true;
  }
  if (!exchanging_.factor(matrix_)) return false;
  exchanging_.solve(b, x);
  return x.allFinite();
}

}  // namespace ballast
