#include "solvers/parts/body_matrix.hpp"

#include <algorithm>

namespace ballast {
namespace {

/// |b - A x| over |b|, above which an LU without exchanged rows is not trusted.
constexpr double most_rest = 1e-8;

/// Everybody that each body touches, itself among them, ascending.
std::vector<std::vector<int>> bodies_in_contact(int bodies,
                                                const std::vector<std::array<int, 2>>& pairs) {
  std::vector<std::vector<int>> near(bodies);
  for (int b = 0; b < bodies; ++b) near[b].push_back(b);
  for (const auto& [a, b] : pairs) {
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

}  // namespace

void BodyMatrix::prepare(const FrictionProblem& problem) {
  const DynamicsForm& d = problem.dynamics;
  problem_ = &problem;
  unit_ = nullptr;
  pair_.resize(problem.contact_count());
  for (int c = 0; c < problem.contact_count(); ++c) pair_[c] = {d.body_a[c], d.body_b[c]};
  analyse(d.dof_begin);
}

// What does not move is one more body, which nothing joins: its unknowns stay zero.
void BodyMatrix::prepare(const UnitMassContacts& contacts) {
  unit_ = &contacts;
  pair_.resize(contacts.contact_count());
  for (int c = 0; c < contacts.contact_count(); ++c)
    for (int s = 0; s < 2; ++s) {
      const int body = contacts[c].body[s];
      pair_[c][s] = body < contacts.body_count() ? body : -1;
    }
  std::vector<int> dof_begin;
  for (int k = 0; k <= contacts.unknown_count(); k += UnitMassContacts::width)
    dof_begin.push_back(k);
  analyse(dof_begin);
}

/// A body's columns have the rows of all that it touches.
void BodyMatrix::analyse(const std::vector<int>& dof_begin) {
  std::vector<int> rows, inner, outer{0};
  const std::vector<std::vector<int>> near =
      bodies_in_contact(static_cast<int>(dof_begin.size()) - 1, pair_);
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
  blocks_.resize(pair_.size());
  for (size_t c = 0; c < pair_.size(); ++c)
    for (int k = 0; k < 4; ++k) blocks_[c][k] = find(pair_[c][k / 2], pair_[c][k % 2]);
  masses_.resize(near.size());
  for (int b = 0; b < static_cast<int>(near.size()); ++b) masses_[b] = find(b, b);
  fronts_.analyse(matrix_, dof_begin);
}

void BodyMatrix::add_masses() {
  for (int b = 0; b < static_cast<int>(masses_.size()); ++b) {
    if (unit_) {
      for (int i = 0; i < UnitMassContacts::width; ++i) column(masses_[b], i)[i] = 1.0;
      continue;
    }
    const DynamicsForm& d = problem_->dynamics;
    const int n = d.body_dofs(b);
    const double* mass = d.mass.data() + d.mass_begin[b];
    for (int j = 0; j < n; ++j) std::copy_n(mass + j * n, n, column(masses_[b], j));
  }
}

/// Adds H^T E H of one contact.
void BodyMatrix::add_contact(int c, const Eigen::Matrix3d& e) {
  const DynamicsForm& d = problem_->dynamics;
  const int rows = problem_->contact_rows(c);
  const auto dofs = [&](int side) { return d.body_dofs(pair_[c][side]); };
  const double* first = d.h.data() + d.h_begin[c];  // column-major, rows x dofs
  const double* h[2] = {first, first + rows * dofs(0)};
  for (int k = 0; k < 4; ++k) {
    if (blocks_[c][k].height == 0) continue;
    const double *left = h[k / 2], *right = h[k % 2];
    // Column by column: E times a column of the right H, then the left H^T times that.
    for (int j = 0; j < dofs(k % 2); ++j) {
      double eh[3] = {0.0, 0.0, 0.0};
      for (int i = 0; i < rows; ++i)
        for (int l = 0; l < rows; ++l) eh[i] += e(i, l) * right[j * rows + l];
      double* sum = column(blocks_[c][k], j);
      for (int i = 0; i < dofs(k / 2); ++i)
        for (int l = 0; l < rows; ++l) sum[i] += left[i * rows + l] * eh[l];
    }
  }
}

/// Adds G^T E G of one contact.
void BodyMatrix::add_unit_contact(int c, const Eigen::Matrix3d& e) {
  constexpr int width = UnitMassContacts::width;
  const auto& g = (*unit_)[c].g;
  for (int p = 0; p < 2; ++p) {
    const Eigen::Matrix<double, width, 3> left = g[p].transpose() * e;
    for (int q = 0; q < 2; ++q) {
      const Place& place = blocks_[c][2 * p + q];
      if (place.height == 0) continue;
      const Eigen::Matrix<double, width, width> block = left * g[q];
      for (int j = 0; j < width; ++j)
        Eigen::Map<Eigen::Matrix<double, width, 1>>(column(place, j)) += block.col(j);
    }
  }
}

bool BodyMatrix::factor(const std::vector<Eigen::Matrix3d>& gain) {
  std::fill_n(matrix_.valuePtr(), matrix_.nonZeros(), 0.0);
  add_masses();
  for (int c = 0; c < static_cast<int>(pair_.size()); ++c)
    if (!gain[c].isZero(0.0)) unit_ ? add_unit_contact(c, gain[c]) : add_contact(c, gain[c]);
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
  exchanging_.solve(b, x);
  return x.allFinite();
}

}  // namespace ballast
