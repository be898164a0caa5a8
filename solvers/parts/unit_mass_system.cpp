#include "solvers/parts/unit_mass_system.hpp"

#include <algorithm>

#include "solvers/parts/bodies_in_contact.hpp"

namespace ballast {
namespace {

constexpr int width = UnitMassContacts::width;

}  // namespace

// What does not move is one more body, which nothing joins: its unknowns stay zero.
void UnitMassSystem::prepare(const UnitMassContacts& contacts) {
  contacts_ = &contacts;
  const int bodies = contacts.body_count() + 1;
  std::vector<std::vector<int>> near = bodies_in_contact(
      contacts.body_count(), contacts.contact_count(),
      [&contacts](int c) { return std::pair(contacts[c].body[0], contacts[c].body[1]); });
  near.push_back({contacts.body_count()});
  // Every body's columns have the rows of all its neighbours.
  std::vector<int> unknown_begin(bodies + 1);
  int entries = 0;
  for (int b = 0; b <= bodies; ++b) unknown_begin[b] = width * b;
  for (const std::vector<int>& list : near)
    entries += width * width * static_cast<int>(list.size());
  matrix_.resize(width * bodies, width * bodies);
  matrix_.resizeNonZeros(entries);
  int at = 0;
  for (int b = 0; b < bodies; ++b)
    for (int k = 0; k < width; ++k) {
      matrix_.outerIndexPtr()[width * b + k] = at;
      for (const int n : near[b])
        for (int i = 0; i < width; ++i) matrix_.innerIndexPtr()[at++] = width * n + i;
    }
  matrix_.outerIndexPtr()[width * bodies] = at;
  // Where the blocks go.
  const auto find = [&](int row_body, int column_body) {
    const std::vector<int>& list = near[column_body];
    const auto place = std::lower_bound(list.begin(), list.end(), row_body) - list.begin();
    return matrix_.outerIndexPtr()[width * column_body] + width * static_cast<int>(place);
  };
  offset_.assign(contacts.contact_count(), {-1, -1, -1, -1});
  for (int c = 0; c < contacts.contact_count(); ++c)
    for (int p = 0; p < 2; ++p)
      for (int q = 0; q < 2; ++q) {
        const int row = contacts[c].body[p], column = contacts[c].body[q];
        if (row < bodies - 1 && column < bodies - 1) offset_[c][2 * p + q] = find(row, column);
      }
  diagonal_.resize(bodies);
  for (int b = 0; b < bodies; ++b) diagonal_[b] = find(b, b);
  factor_.analyse(matrix_, unknown_begin);
}

/// Adds G^T K G of two sides: `left` is G^T K of one, `side` the other.
void UnitMassSystem::add_block(const UnitMassContacts::Contact& contact,
                               const Eigen::Matrix<double, 6, 3>& left, int side, int offset) {
  const int* outer = matrix_.outerIndexPtr() + width * contact.body[side];
  const int height = outer[1] - outer[0];
  const Eigen::Matrix<double, width, width> block = left * contact.g[side];
  double* column = matrix_.valuePtr() + offset;
  for (int j = 0; j < width; ++j, column += height)
    Eigen::Map<Eigen::Matrix<double, width, 1>>(column) += block.col(j);
}

bool UnitMassSystem::factor(const std::vector<Eigen::Matrix3d>& gain) {
  gain_ = &gain;
  std::fill_n(matrix_.valuePtr(), matrix_.nonZeros(), 0.0);
  // The unit masses.
  for (int b = 0; b < static_cast<int>(diagonal_.size()); ++b) {
    const int* outer = matrix_.outerIndexPtr() + width * b;
    for (int i = 0; i < width; ++i)
      matrix_.valuePtr()[diagonal_[b] + i * (outer[1] - outer[0]) + i] = 1.0;
  }
  for (int c = 0; c < contacts_->contact_count(); ++c) {
    if (gain[c].isZero(0.0)) continue;
    const UnitMassContacts::Contact& k = (*contacts_)[c];
    for (int p = 0; p < 2; ++p) {
      const Eigen::Matrix<double, 6, 3> left = k.g[p].transpose() * gain[c];
      for (int q = 0; q < 2; ++q)
        if (offset_[c][2 * p + q] >= 0) add_block(k, left, q, offset_[c][2 * p + q]);
    }
  }
  return factor_.factor(matrix_);
}

void UnitMassSystem::solve(const Eigen::VectorXd& b, Eigen::VectorXd& x) {
  factor_.solve(b, x);
  // What is left of b, by way of the contacts: cheaper than the matrix.
  residual_ = b - x;
  for (int c = 0; c < contacts_->contact_count(); ++c) {
    const Eigen::Matrix3d& gain = (*gain_)[c];
    if (!gain.isZero(0.0)) contacts_->push(residual_, c, -(gain * contacts_->relative(x, c)));
  }
  if (!(residual_.norm() > 1e-10 * b.norm())) return;
  factor_.solve(residual_, correction_);
  x += correction_;
}

}  // namespace ballast
