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

/// Three rows per contact.
void set_contacts(FrictionProblem& problem, const std::vector<double>& mu) {
  problem.friction = mu;
  problem.row_begin.resize(mu.size() + 1);
  for (std::size_t c = 0; c <= mu.size(); ++c) problem.row_begin[c] = 3 * static_cast<int>(c);
}

/// The bodies of every contact when `size` consecutive unknowns make a body; none when M or H
/// forbid it. The size is known to the compiler: a division by it is made for every entry of H.
template <int size>
class Grouping {
 public:
  explicit Grouping(const GlobalProblem& global) {
    fits_ = global.m.rows() % size <= 1 && mass_is_block_diagonal(global.m) &&
            find_bodies_of_contacts(global);
  }
  bool fits() const { return fits_; }
  const std::vector<int>& body_a() const { return body_a_; }
  const std::vector<int>& body_b() const { return body_b_; }

 private:
  bool mass_is_block_diagonal(const SparseColumns& m) const {
    for (int column = 0; column < m.outerSize(); ++column)
      for (SparseColumns::InnerIterator entry(m, column); entry; ++entry)
        if (entry.value() != 0.0 && entry.row() / size != column / size) return false;
    return true;
  }

  bool find_bodies_of_contacts(const GlobalProblem& global) {
    const size_t contacts = global.mu.size();
    body_a_.assign(contacts, -1);
    body_b_.assign(contacts, -1);
    // Column 3 c + k of H is row k of contact c; the unknowns in it say which bodies it touches.
    for (int column = 0; column < global.h.outerSize(); ++column) {
      int &a = body_a_[column / 3], &b = body_b_[column / 3];
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

  bool fits_;
  std::vector<int> body_a_, body_b_;
};

template <int size>
void fill_bodies(const GlobalProblem& global, DynamicsForm& dynamics) {
  const int unknowns = static_cast<int>(global.m.rows());
  // f = M v_free is an impulse: v_free block by block, with the masses' own factors.
  dynamics.v_free = global.f;
  for (int first = 0; first < unknowns; first += size) {
    const int count = std::min(size, unknowns - first);
    Eigen::MatrixXd block = Eigen::MatrixXd::Zero(count, count);
    for (int column = 0; column < count; ++column)
      for (SparseColumns::InnerIterator entry(global.m, first + column); entry; ++entry)
        if (entry.row() / size == first / size) block(entry.row() - first, column) = entry.value();
    dynamics.dof_begin.push_back(first + count);
    dynamics.mass.insert(dynamics.mass.end(), block.data(), block.data() + block.size());
    dynamics.mass_begin.push_back(static_cast<int>(dynamics.mass.size()));
    MassRoot root;
    if (!root.factor(block.data(), count))
      throw InvalidProblem("M(" + std::to_string(first) + ", " + std::to_string(first) + ") = " +
                           std::to_string(block(0, 0)) + ": the block is not positive definite");
    root.solve_lower(dynamics.v_free.data() + first);
    root.solve_upper(dynamics.v_free.data() + first);
  }
}

template <int size>
void fill_contacts(const GlobalProblem& global, const Grouping<size>& grouping,
                   DynamicsForm& dynamics) {
  dynamics.body_a = grouping.body_a();
  dynamics.body_b = grouping.body_b();
  const size_t contacts = global.mu.size();
  dynamics.h.reserve(2 * 3 * size * contacts);
  for (size_t c = 0; c < contacts; ++c) {
    // Three columns of H are one contact; transposed, their rows of a body are its block.
    for (const int body : {dynamics.body_a[c], dynamics.body_b[c]}) {
      if (body < 0) continue;
      const size_t begin = dynamics.h.size();
      dynamics.h.resize(begin + 3 * static_cast<size_t>(dynamics.body_dofs(body)));
      for (int i = 0; i < 3; ++i)
        for (SparseColumns::InnerIterator entry(global.h, 3 * static_cast<int>(c) + i); entry;
             ++entry)
          if (entry.row() / size == body)
            dynamics.h[begin + 3 * static_cast<size_t>(entry.row() - body * size) + i] =
                entry.value();
    }
    dynamics.h_begin.push_back(static_cast<int>(dynamics.h.size()));
  }
  dynamics.bias = global.w;
}

/// The dynamics form with bodies of `size` unknowns, into `problem`; false: M or H forbid it.
template <int size>
bool group_into_bodies(const GlobalProblem& global, FrictionProblem& problem) {
  const Grouping<size> grouping(global);
  if (!grouping.fits()) return false;
  set_contacts(problem, global.mu);
  problem.has_dynamics = true;
  fill_bodies<size>(global, problem.dynamics);
  fill_contacts(global, grouping, problem.dynamics);
  return true;
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

/// Row of a three-row file in which our row `row` of contact c is.
int file_row(const FrictionProblem& problem, int c, int row) {
  return 3 * c + row - problem.row_begin[c];
}

/// Our row of every row of the file; -1 for the tangents that a one-row contact does not have.
std::vector<int> file_rows(const FrictionProblem& problem) {
  std::vector<int> rows(problem.row_count());
  for (int c = 0; c < problem.contact_count(); ++c)
    for (int row = problem.row_begin[c]; row < problem.row_begin[c + 1]; ++row)
      rows[row] = file_row(problem, c, row);
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
  set_contacts(problem, local.mu);
  problem.has_delassus = true;
  problem.delassus.w.swap(local.w);
  problem.delassus.w.makeCompressed();
  problem.delassus.q = std::move(local.q);
  return problem;
}

FrictionProblem to_friction_problem(const GlobalProblem& global) {
  // The first grouping that M and H allow: rigid bodies, or points; where none does, W is formed.
  FrictionProblem problem;
  if (group_into_bodies<6>(global, problem) || group_into_bodies<3>(global, problem))
    return problem;
  return condense(global);
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

LocalProblem to_local_problem(const FrictionProblem& problem) {
  if (problem.row_count() == 3 * problem.contact_count())
    return {problem.delassus.w, problem.delassus.q, problem.friction};
  const std::vector<int> rows = file_rows(problem);
  std::vector<Eigen::Triplet<double>> entries;
  for (int row = 0; row < problem.row_count(); ++row)
    for (SparseRows::InnerIterator entry(problem.delassus.w, row); entry; ++entry)
      entries.emplace_back(rows[row], rows[entry.col()], entry.value());
  LocalProblem local;
  local.w.resize(3 * problem.contact_count(), 3 * problem.contact_count());
  local.w.setFromTriplets(entries.begin(), entries.end());
  local.q = three_rows(problem, problem.delassus.q);
  local.mu = problem.friction;
  return local;
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
  if (problem.row_count() == 3 * problem.contact_count()) {
    LocalProblem local{delassus_matrix(problem), {}, problem.friction};
    free_contact_velocity(problem, local.q);
    return local;
  }
  FrictionProblem stored;
  stored.row_begin = problem.row_begin;
  stored.friction = problem.friction;
  stored.has_delassus = true;
  stored.delassus.w = delassus_matrix(problem);
  free_contact_velocity(problem, stored.delassus.q);
  return to_local_problem(stored);
}

}  // namespace ballast
