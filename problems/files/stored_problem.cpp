#include "problems/files/stored_problem.hpp"

#include <algorithm>
#include <string>
#include <utility>

#include <Eigen/SparseLU>

#include "problems/algebra/delassus.hpp"
#include "problems/algebra/mass_root.hpp"

namespace ballast {
namespace {

using SparseColumns = Eigen::SparseMatrix<double>;

/// Bodies of `size` consecutive unknowns each, and one of what is left behind the last. False: M or
/// H forbid it. The size is known to the compiler: a division by it is made for every entry of H.
template <int size>
bool group(const GlobalProblem& global, Division& division) {
  const int unknowns = static_cast<int>(global.m.rows());
  if (unknowns % size > 1) return false;
  for (int column = 0; column < unknowns; ++column)
    for (SparseColumns::InnerIterator entry(global.m, column); entry; ++entry)
      if (entry.value() != 0.0 && entry.row() / size != column / size) return false;
  division = {};
  for (int first = 0; first < unknowns; first += size)
    division.dof_begin.push_back(std::min(first + size, unknowns));
  const size_t contacts = global.mu.size();
  division.rows.assign(contacts, 3);
  division.body_a.assign(contacts, -1);
  division.body_b.assign(contacts, -1);
  // Column 3 c + k of H is row k of contact c; the unknowns in it say which bodies it touches.
  for (int column = 0; column < global.h.outerSize(); ++column) {
    int &a = division.body_a[column / 3], &b = division.body_b[column / 3];
    for (SparseColumns::InnerIterator entry(global.h, column); entry; ++entry) {
      const int body = static_cast<int>(entry.row()) / size;
      if (entry.value() == 0.0 || body == a || body == b) continue;
      if (b == -1)
        b = body;
      else if (a == -1)
        a = body;
      else
        return false;
    }
  }
  return true;
}

/// Writes what columns first ... of a sparse matrix have in rows row_begin <= row < row_end to a
/// dense block, by its own strides.
void copy_block(const SparseColumns& from, int first, int columns, int row_begin, int row_end,
                double* to, int row_stride, int column_stride) {
  for (int k = 0; k < columns; ++k)
    for (SparseColumns::InnerIterator entry(from, first + k); entry; ++entry)
      if (entry.row() >= row_begin && entry.row() < row_end)
        to[(entry.row() - row_begin) * row_stride + k * column_stride] = entry.value();
}

/// W = H^T M^-1 H and q = H^T M^-1 f + w. By LU: stored iteration matrices need not be quite
/// symmetric.
FrictionProblem condense(const GlobalProblem& global) {
  Eigen::SparseLU<SparseColumns> factor(global.m);
  if (factor.info() != Eigen::Success) throw InvalidProblem("M is singular");
  LocalProblem local;
  const SparseColumns solved = factor.solve(global.h);
  local.w = global.h.transpose() * solved;
  local.q = global.h.transpose() * factor.solve(global.f) + global.w;
  local.mu = global.mu;
  return to_friction_problem(std::move(local));
}

/// Where each of our rows is among three per contact.
std::vector<int> file_rows(const FrictionProblem& problem) {
  std::vector<int> rows(problem.row_count());
  for (int c = 0; c < problem.contact_count(); ++c)
    for (int row = problem.row_begin[c]; row < problem.row_begin[c + 1]; ++row)
      rows[row] = 3 * c + row - problem.row_begin[c];
  return rows;
}

/// The file's H: ours transposed. Tangents that a one-row contact has not are empty columns.
SparseColumns transposed_h(const FrictionProblem& problem) {
  const DynamicsForm& dynamics = problem.dynamics;
  SparseColumns h(dynamics.dof_count(), 3 * problem.contact_count());
  h.reserve(static_cast<Eigen::Index>(dynamics.h.size()));
  for (int c = 0; c < problem.contact_count(); ++c) {
    const int rows = problem.contact_rows(c), a = dynamics.body_a[c], b = dynamics.body_b[c];
    const double* of_a = dynamics.h.data() + dynamics.h_begin[c];
    const double* of_b = of_a + rows * dynamics.body_dofs(a);
    for (int i = 0; i < 3; ++i) {
      const int column = 3 * c + i;
      h.startVec(column);
      if (i >= rows) continue;
      const auto add = [&](int body, const double* block) {
        for (int k = 0; k < dynamics.body_dofs(body); ++k)
          h.insertBack(dynamics.dof_begin[body] + k, column) = block[k * rows + i];
      };
      // Rows of a column ascend.
      if (a < b) add(a, of_a);
      add(b, of_b);
      if (a > b) add(a, of_a);
    }
  }
  h.finalize();
  return h;
}

}  // namespace

FrictionProblem to_friction_problem(LocalProblem local) {
  FrictionProblem problem;
  problem.friction = std::move(local.mu);
  for (int c = 0; c < problem.contact_count(); ++c) problem.row_begin.push_back(3 * (c + 1));
  problem.has_delassus = true;
  problem.delassus.w.swap(local.w);
  problem.delassus.w.makeCompressed();
  problem.delassus.q = std::move(local.q);
  return problem;
}

FrictionProblem divided(const GlobalProblem& global, const Division& division) {
  FrictionProblem problem;
  problem.friction = global.mu;
  problem.has_dynamics = true;
  DynamicsForm& dynamics = problem.dynamics;
  dynamics.dof_begin = division.dof_begin;
  dynamics.body_a = division.body_a;
  dynamics.body_b = division.body_b;
  // M is block diagonal: a body's mass is its diagonal block.
  for (int b = 0; b < dynamics.body_count(); ++b) {
    const int first = dynamics.dof_begin[b], dofs = dynamics.body_dofs(b);
    const int begin = dynamics.mass_begin.back();
    dynamics.mass.resize(begin + dofs * dofs);
    copy_block(global.m, first, dofs, first, first + dofs, dynamics.mass.data() + begin, 1, dofs);
    dynamics.mass_begin.push_back(begin + dofs * dofs);
  }
  // FCLIB has u = H^T v + w: a contact is three columns of H, and the transposes of what stands
  // there in the rows of either body are the blocks of ours.
  std::vector<double> bias;
  for (int c = 0; c < problem.contact_count(); ++c) {
    const int rows = division.rows[c];
    for (const int body : {dynamics.body_a[c], dynamics.body_b[c]}) {
      if (body < 0) continue;
      const int first = dynamics.dof_begin[body], dofs = dynamics.body_dofs(body);
      dynamics.h.resize(dynamics.h.size() + rows * dofs);
      copy_block(global.h, 3 * c, rows, first, first + dofs,
                 dynamics.h.data() + dynamics.h.size() - rows * dofs, rows, 1);
    }
    dynamics.h_begin.push_back(static_cast<int>(dynamics.h.size()));
    problem.row_begin.push_back(problem.row_begin.back() + rows);
    for (int row = 0; row < rows; ++row) bias.push_back(global.w[3 * c + row]);
  }
  dynamics.bias = as_eigen(bias);
  return problem;
}

FrictionProblem to_friction_problem(const GlobalProblem& global) {
  // The first grouping that M and H allow: rigid bodies, or points; where none does, W is formed.
  Division division;
  if (!group<6>(global, division) && !group<3>(global, division)) return condense(global);
  FrictionProblem problem = divided(global, division);
  // f = M v_free is an impulse: v_free block by block, with the masses' own factors.
  DynamicsForm& dynamics = problem.dynamics;
  dynamics.v_free = global.f;
  for (int b = 0; b < dynamics.body_count(); ++b) {
    const int first = dynamics.dof_begin[b];
    const double* block = dynamics.mass.data() + dynamics.mass_begin[b];
    MassRoot root;
    if (!root.factor(block, dynamics.body_dofs(b)))
      throw InvalidProblem("M(" + std::to_string(first) + ", " + std::to_string(first) + ") = " +
                           std::to_string(block[0]) + ": the block is not positive definite");
    root.solve_lower(dynamics.v_free.data() + first);
    root.solve_upper(dynamics.v_free.data() + first);
  }
  return problem;
}

Eigen::VectorXd three_rows(const FrictionProblem& problem, const Eigen::VectorXd& x) {
  const std::vector<int> rows = file_rows(problem);
  Eigen::VectorXd wide = Eigen::VectorXd::Zero(3 * problem.contact_count());
  for (std::size_t i = 0; i < rows.size(); ++i) wide[rows[i]] = x[i];
  return wide;
}

Eigen::VectorXd own_rows(const FrictionProblem& problem, const Eigen::VectorXd& wide) {
  const std::vector<int> rows = file_rows(problem);
  Eigen::VectorXd x(problem.row_count());
  for (std::size_t i = 0; i < rows.size(); ++i) x[i] = wide[rows[i]];
  return x;
}

GlobalProblem to_global_problem(const FrictionProblem& problem) {
  GlobalProblem global;
  global.h = transposed_h(problem);
  global.m = sparse_mass(problem.dynamics);
  global.f = global.m * problem.dynamics.v_free;
  global.w = three_rows(problem, problem.dynamics.bias);
  global.mu = problem.friction;
  return global;
}

LocalProblem condensed(const FrictionProblem& problem) {
  LocalProblem local{delassus_matrix(problem), {}, problem.friction};
  free_contact_velocity(problem, local.q);
  const int wide = 3 * problem.contact_count();
  if (problem.row_count() == wide) return local;
  const std::vector<int> rows = file_rows(problem);
  std::vector<Eigen::Triplet<double>> entries;
  for (int row = 0; row < problem.row_count(); ++row)
    for (SparseRows::InnerIterator entry(local.w, row); entry; ++entry)
      entries.emplace_back(rows[row], rows[entry.col()], entry.value());
  local.w.resize(wide, wide);
  local.w.setFromTriplets(entries.begin(), entries.end());
  local.q = three_rows(problem, local.q);
  return local;
}

}  // namespace ballast
