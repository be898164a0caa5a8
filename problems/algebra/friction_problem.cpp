#include "problems/algebra/friction_problem.hpp"

#include <atomic>
#include <bit>
#include <cmath>
#include <cstdint>
#include <sstream>
#include <string>

#include "platform/for_each_cpu.hpp"
#include "platform/worker_team.hpp"

namespace ballast {
namespace {

/// u += B v for a column-major block of Rows x dofs. The sums are local variables: for the compiler
/// u might be part of B.
template <int Rows>
[[gnu::always_inline]] inline void multiply_add(const double* block, int dofs, const double* v,
                                                double* u) {
  double sum[Rows];
  for (int i = 0; i < Rows; ++i) sum[i] = u[i];
  for (int k = 0; k < dofs; ++k)
    for (int i = 0; i < Rows; ++i) sum[i] += block[k * Rows + i] * v[k];
  for (int i = 0; i < Rows; ++i) u[i] = sum[i];
}

/// v += B^T r.
template <int Rows>
[[gnu::always_inline]] inline void transposed_multiply_add(const double* block, int dofs,
                                                           const double* r, double* v) {
  double weight[Rows];
  for (int i = 0; i < Rows; ++i) weight[i] = r[i];
  for (int k = 0; k < dofs; ++k) {
    double sum = 0.0;
    for (int i = 0; i < Rows; ++i) sum += block[k * Rows + i] * weight[i];
    v[k] += sum;
  }
}

/// Adds one contact's rows of H v to u. The six unknowns of a rigid body are a constant, so that
/// the compiler unrolls.
template <int Rows>
inline void contact_row_velocity(const DynamicsForm& dynamics, int c, const double* v, double* u) {
  const double* block = dynamics.h.data() + dynamics.h_begin[c];
  for (const int body : {dynamics.body_a[c], dynamics.body_b[c]}) {
    // A side that does not move has no block.
    if (body < 0) continue;
    const int dofs = dynamics.body_dofs(body);
    const double* vb = v + dynamics.dof_begin[body];
    if (dofs == 6)
      multiply_add<Rows>(block, 6, vb, u);
    else
      multiply_add<Rows>(block, dofs, vb, u);
    block += Rows * dofs;
  }
}

/// Adds one contact's part of H^T r for those of its bodies that lie in [begin, end).
template <int Rows>
inline void add_contact_impulse(const DynamicsForm& dynamics, int c, const double* r, int begin,
                                int end, double* v) {
  const double* block = dynamics.h.data() + dynamics.h_begin[c];
  for (const int body : {dynamics.body_a[c], dynamics.body_b[c]}) {
    if (body < 0) continue;
    const int dofs = dynamics.body_dofs(body);
    double* vb = v + dynamics.dof_begin[body];
    const bool is_asked = begin <= body && body < end;
    if (is_asked && dofs == 6)
      transposed_multiply_add<Rows>(block, 6, r, vb);
    else if (is_asked)
      transposed_multiply_add<Rows>(block, dofs, r, vb);
    block += Rows * dofs;
  }
}

}  // namespace

int DynamicsForm::add_body(const Eigen::MatrixXd& block) {
  dof_begin.push_back(dof_begin.back() + static_cast<int>(block.rows()));
  mass.insert(mass.end(), block.data(), block.data() + block.size());
  mass_begin.push_back(static_cast<int>(mass.size()));
  return body_count() - 1;
}

void FrictionProblem::add_contact(int a, int b, double mu, const Eigen::MatrixXd& h_a,
                                  const Eigen::MatrixXd& h_b) {
  for (const Eigen::MatrixXd* block : {&h_a, &h_b})
    dynamics.h.insert(dynamics.h.end(), block->data(), block->data() + block->size());
  dynamics.h_begin.push_back(static_cast<int>(dynamics.h.size()));
  dynamics.body_a.push_back(a);
  dynamics.body_b.push_back(b);
  row_begin.push_back(row_begin.back() + static_cast<int>(h_b.rows()));
  friction.push_back(mu);
}

void FrictionProblem::clear_contacts() {
  for (std::vector<int>* begin : {&row_begin, &dynamics.h_begin}) begin->assign(1, 0);
  for (std::vector<int>* bodies : {&dynamics.body_a, &dynamics.body_b}) bodies->clear();
  friction.clear();
}

void body_to_contact_velocity(const DynamicsForm& dynamics, const std::vector<int>& row_begin,
                              const Eigen::VectorXd& v, int begin, int end, Eigen::VectorXd& u) {
  // u begins as the bias, and every contact adds its rows of H v.
  for (int i = row_begin[begin]; i < row_begin[end]; ++i) u[i] = dynamics.bias[i];
  for (int c = begin; c < end; ++c) {
    double* uc = u.data() + row_begin[c];
    if (row_begin[c + 1] - row_begin[c] == 3)
      contact_row_velocity<3>(dynamics, c, v.data(), uc);
    else
      contact_row_velocity<1>(dynamics, c, v.data(), uc);
  }
}

void body_to_contact_velocity(const DynamicsForm& dynamics, const std::vector<int>& row_begin,
                              const Eigen::VectorXd& v, Eigen::VectorXd& u) {
  u.resize(row_begin.back());
  body_to_contact_velocity(dynamics, row_begin, v, 0, static_cast<int>(row_begin.size()) - 1, u);
}

void contact_to_body_impulse(const DynamicsForm& dynamics, const std::vector<int>& row_begin,
                             const Impulses& r, Eigen::VectorXd& p) {
  p.resize(dynamics.dof_count());
  contact_to_body_impulse(dynamics, row_begin, r, 0, dynamics.body_count(), p);
}

void contact_to_body_impulse(const DynamicsForm& dynamics, const std::vector<int>& row_begin,
                             const Impulses& r, int begin, int end, Eigen::VectorXd& p) {
  const int first = dynamics.dof_begin[begin];
  p.segment(first, dynamics.dof_begin[end] - first).setZero();
  const int contacts = static_cast<int>(row_begin.size()) - 1;
  for (int c = 0; c < contacts; ++c) {
    const double* rc = r.data() + row_begin[c];
    if (row_begin[c + 1] - row_begin[c] == 3)
      add_contact_impulse<3>(dynamics, c, rc, begin, end, p.data());
    else
      add_contact_impulse<1>(dynamics, c, rc, begin, end, p.data());
  }
}

void free_contact_velocity(const FrictionProblem& problem, Eigen::VectorXd& q) {
  if (problem.has_dynamics)
    body_to_contact_velocity(problem.dynamics, problem.row_begin, problem.dynamics.v_free, q);
  else
    q = problem.delassus.q;
}

void require_rows(const Impulses& r, int rows) {
  if (r.size() != rows)
    throw InvalidProblem("impulses has " + std::to_string(r.size()) +
                         " entries, the contacts have " + std::to_string(rows) + " rows");
}

void contact_velocity(const FrictionProblem& problem, const Impulses& r, Eigen::VectorXd& u) {
  require_rows(r, problem.row_count());
  // u = H v + bias with the bodies' velocities under the impulses, or u = W r + q as it is stored.
  if (problem.has_dynamics) {
    Eigen::VectorXd v;
    body_velocity(problem.dynamics, problem.row_begin, r, v);
    body_to_contact_velocity(problem.dynamics, problem.row_begin, v, u);
  } else {
    u = problem.delassus.q;
    u.noalias() += problem.delassus.w * r;
  }
}

void body_velocity(const DynamicsForm& dynamics, const std::vector<int>& row_begin,
                   const Impulses& r, Eigen::VectorXd& v) {
  require_rows(r, row_begin.back());
  contact_to_body_impulse(dynamics, row_begin, r, v);
  std::vector<MassRoot> roots;
  factor_masses(dynamics, roots);
  solve_masses(dynamics, roots, v);
  v += dynamics.v_free;
}

void factor_masses(const DynamicsForm& dynamics, std::vector<MassRoot>& roots) {
  roots.resize(dynamics.body_count());
  for (int b = 0; b < dynamics.body_count(); ++b)
    if (!roots[b].factor(dynamics.mass.data() + dynamics.mass_begin[b], dynamics.body_dofs(b)))
      throw InvalidProblem("dynamics.mass: the block of body " + std::to_string(b) +
                           " is not positive definite");
}

void solve_masses(const DynamicsForm& dynamics, const std::vector<MassRoot>& roots,
                  Eigen::VectorXd& v) {
  for (int b = 0; b < dynamics.body_count(); ++b) roots[b].solve(v.data() + dynamics.dof_begin[b]);
}

Eigen::SparseMatrix<double> sparse_mass(const DynamicsForm& dynamics) {
  // Zeros beside the diagonal are left out: most masses are diagonal.
  std::vector<Eigen::Triplet<double>> entries;
  entries.reserve(dynamics.mass.size());
  for (int b = 0; b < dynamics.body_count(); ++b) {
    const int dofs = dynamics.body_dofs(b), first = dynamics.dof_begin[b];
    const double* block = dynamics.mass.data() + dynamics.mass_begin[b];
    for (int j = 0; j < dofs; ++j)
      for (int i = 0; i < dofs; ++i)
        if (i == j || block[j * dofs + i] != 0.0)
          entries.emplace_back(first + i, first + j, block[j * dofs + i]);
  }
  Eigen::SparseMatrix<double> mass(dynamics.dof_count(), dynamics.dof_count());
  mass.setFromTriplets(entries.begin(), entries.end());
  return mass;
}

SparseRows sparse_h(const FrictionProblem& problem) {
  const DynamicsForm& dynamics = problem.dynamics;
  std::vector<Eigen::Triplet<double>> entries;
  entries.reserve(dynamics.h.size());
  for (int c = 0; c < problem.contact_count(); ++c) {
    const int rows = problem.contact_rows(c);
    const double* block = dynamics.h.data() + dynamics.h_begin[c];
    for (const int body : {dynamics.body_a[c], dynamics.body_b[c]}) {
      const int dofs = dynamics.body_dofs(body);
      for (int k = 0; k < dofs; ++k)
        for (int i = 0; i < rows; ++i)
          entries.emplace_back(problem.row_begin[c] + i, dynamics.dof_begin[body] + k,
                               block[k * rows + i]);
      block += rows * dofs;
    }
  }
  SparseRows h(problem.row_count(), dynamics.dof_count());
  h.setFromTriplets(entries.begin(), entries.end());
  return h;
}

Eigen::Matrix3d stored_diagonal_block(const FrictionProblem& problem, int c) {
  Eigen::Matrix3d block = Eigen::Matrix3d::Zero();
  const int first = problem.row_begin[c], rows = problem.contact_rows(c);
  for (int i = 0; i < rows; ++i)
    for (SparseRows::InnerIterator entry(problem.delassus.w, first + i); entry; ++entry) {
      const int j = static_cast<int>(entry.col()) - first;
      if (j >= 0 && j < rows) block(i, j) = entry.value();
    }
  return block;
}

// validate(): fast loops tell whether any entry is bad; only then a slow loop finds and names it.
namespace {

/// Largest asymmetry |x_ij - x_ji| of a block, relative to its diagonal. Masses have the rounding
/// of rotated inertias. Implicit gyroscopic terms make some stored Delassus operators truly
/// unsymmetric (FCLIB's RockPile by 2 %, others by 16 %), and the law must hold for W as it is:
/// only a block whose antisymmetric part outweighs its diagonal is refused.
constexpr double mass_asymmetry = 1e-10;
constexpr double delassus_asymmetry = 2.0;
/// A minor of a stored block may be below zero by this much, relative, as rounding: some files hold
/// six digits.
constexpr double semidefinite_rounding = 1e-5;

template <typename... Parts>
[[noreturn]] void fail(const Parts&... parts) {
  std::ostringstream text;
  text.precision(17);
  (text << ... << parts);
  throw InvalidProblem(text.str());
}

void require_size(const char* array, std::size_t size, int expected, const char* because) {
  if (size != static_cast<std::size_t>(expected))
    fail(array, " has ", size, " entries; ", because, " needs ", expected);
}

/// `place...` names the array and the place in it.
template <typename... Place>
void require_number(double x, const Place&... place) {
  if (!std::isfinite(x)) fail(place..., " = ", x, " is not finite");
  if (std::abs(x) > largest_entry)
    fail(place..., " = ", x, " is beyond ", largest_entry, ", where squares and products overflow");
}

/// Numbers >= 0 are ordered like their bits, infinity and NaN after all others. The comparison is
/// of integers, so that the compiler vectorises the reduction.
BALLAST_FOR_EACH_CPU bool is_any_too_large(const double* x, long size) {
  constexpr std::uint64_t magnitude = 0x7fffffffffffffffull;
  constexpr std::uint64_t largest = std::bit_cast<std::uint64_t>(largest_entry);
  std::uint64_t bad = 0;
  // As integers, `largest` minus anything larger, infinite or NaN is negative: its top bit is set.
  for (long i = 0; i < size; ++i)
    bad |= (largest - (std::bit_cast<std::uint64_t>(x[i]) & magnitude)) >> 63;
  return bad != 0;
}

template <typename Numbers>
void require_numbers(const char* array, const Numbers& x, int size, const char* because) {
  require_size(array, static_cast<std::size_t>(x.size()), size, because);
  if (!is_any_too_large(x.data(), size)) return;
  for (int i = 0; i < size; ++i) require_number(x[i], array, "[", i, "]");
}

void require_begin(const char* array, const std::vector<int>& begin, int count, const char* of) {
  require_size(array, begin.size(), count + 1, of);
  if (begin[0] != 0) fail(array, "[0] = ", begin[0], ", must be 0");
}

// Checks sizes first, so that all later checks may index freely.
void validate_contacts(const FrictionProblem& problem) {
  const int contacts = problem.contact_count();
  require_begin("row_begin", problem.row_begin, contacts, "one friction coefficient per contact");
  require_numbers("friction", problem.friction, contacts, "");
  for (int c = 0; c < contacts; ++c) {
    const int rows = problem.contact_rows(c);
    if (rows != 1 && rows != 3)
      fail("row_begin[", c + 1, "] = ", problem.row_begin[c + 1], " gives contact ", c, " ", rows,
           " rows; a contact has 1 or 3");
    const double mu = problem.friction[c];
    if (mu < 0.0) fail("friction[", c, "] = ", mu, " is negative");
    if (mu > largest_friction)
      fail("friction[", c, "] = ", mu, " is above ", largest_friction,
           ", which already holds as a bond does: use that");
    if (rows == 1 && mu != 0.0) fail("friction[", c, "] = ", mu, ": a one-row contact has none");
  }
}

// Requires a block that is positive definite and, up to rounding, symmetric.
void validate_mass_block(const DynamicsForm& dynamics, int b) {
  const int dofs = dynamics.body_dofs(b), first = dynamics.mass_begin[b];
  const double* block = dynamics.mass.data() + first;
  // A Cholesky factor exists exactly where the block is positive definite.
  MassRoot root;
  if (!root.factor(block, dofs))
    fail("dynamics.mass[", first, "] = ", block[0], ": the block of body ", b,
         " is not positive definite");
  for (int j = 0; j < dofs; ++j) {
    const double own = block[j * dofs + j];
    if (own < smallest_scale)
      fail("dynamics.mass[", first + j * dofs + j, "] = ", own, " is below ", smallest_scale,
           ", where its inverse overflows");
    for (int i = 0; i < j; ++i) {
      const double upper = block[j * dofs + i], lower = block[i * dofs + j];
      if (std::abs(lower - upper) > mass_asymmetry * std::sqrt(own * block[i * dofs + i]))
        fail("dynamics.mass[", first + j * dofs + i, "] = ", upper, ": the block of body ", b,
             " is not symmetric");
    }
  }
}

void validate_masses(const DynamicsForm& dynamics) {
  if (dynamics.dof_begin.empty()) fail("dynamics.dof_begin is empty; no bodies means {0}");
  const int bodies = dynamics.body_count();
  require_begin("dynamics.dof_begin", dynamics.dof_begin, bodies, "dynamics.dof_begin");
  require_begin("dynamics.mass_begin", dynamics.mass_begin, bodies, "one mass block per body");
  for (int b = 0; b < bodies; ++b) {
    const int dofs = dynamics.body_dofs(b);
    if (dofs < 1 || dofs > MassRoot::max_dofs)
      fail("dynamics.dof_begin[", b + 1, "] = ", dynamics.dof_begin[b + 1], " gives body ", b, " ",
           dofs, " unknowns; a body has 1 to ", MassRoot::max_dofs);
    if (dynamics.mass_begin[b + 1] - dynamics.mass_begin[b] != dofs * dofs)
      fail("dynamics.mass_begin[", b + 1, "] = ", dynamics.mass_begin[b + 1],
           ": the block of body ", b, " must have ", dofs * dofs, " entries");
  }
  require_numbers("dynamics.mass", dynamics.mass, dynamics.mass_begin.back(), "mass_begin");
  for (int b = 0; b < bodies; ++b) validate_mass_block(dynamics, b);
}

/// `is_h_bad`: some entry of H is not finite or too large.
void validate_dynamics(const FrictionProblem& problem, bool is_h_bad) {
  const DynamicsForm& dynamics = problem.dynamics;
  const int contacts = problem.contact_count(), bodies = dynamics.body_count();
  require_numbers("dynamics.v_free", dynamics.v_free, dynamics.dof_count(),
                  "one entry per unknown");
  require_size("dynamics.body_a", dynamics.body_a.size(), contacts, "one entry per contact");
  require_size("dynamics.body_b", dynamics.body_b.size(), contacts, "one entry per contact");
  require_begin("dynamics.h_begin", dynamics.h_begin, contacts, "one block per contact");
  for (int c = 0; c < contacts; ++c) {
    const int a = dynamics.body_a[c], b = dynamics.body_b[c];
    if (a < -1 || a >= bodies)
      fail("dynamics.body_a[", c, "] = ", a, " is not one of the ", bodies, " bodies, nor -1");
    if (b < -1 || b >= bodies)
      fail("dynamics.body_b[", c, "] = ", b, " is not one of the ", bodies, " bodies, nor -1");
    if (a == b && a != -1)
      fail("dynamics.body_b[", c, "] = ", b, ": body_a and body_b are the same body");
    const int entries = problem.contact_rows(c) * (dynamics.body_dofs(a) + dynamics.body_dofs(b));
    if (dynamics.h_begin[c + 1] - dynamics.h_begin[c] != entries)
      fail("dynamics.h_begin[", c + 1, "] = ", dynamics.h_begin[c + 1], ": the blocks of contact ",
           c, " must have ", entries, " entries");
  }
  require_size("dynamics.h", dynamics.h.size(), dynamics.h_begin.back(), "h_begin");
  if (is_h_bad) require_numbers("dynamics.h", dynamics.h, dynamics.h_begin.back(), "h_begin");
  require_numbers("dynamics.bias", dynamics.bias, problem.row_count(), "one entry per contact row");
}

// Requires that the symmetric part is positive semidefinite up to rounding, by all its minors.
void validate_diagonal_block(const FrictionProblem& problem, int c) {
  const Eigen::Matrix3d d = stored_diagonal_block(problem, c), even = 0.5 * (d + d.transpose());
  const int first = problem.row_begin[c];
  const auto fail_at = [&](int i, int j, const auto&... what) {
    fail("delassus.w(", first + i, ", ", first + j, ") = ", d(i, j), what...);
  };
  for (int i = 0; i < 3; ++i)
    if (d(i, i) < 0.0) fail_at(i, i, " is negative");
  const double largest = d.diagonal().maxCoeff();
  if (largest > 0.0 && largest < smallest_scale)
    fail_at(0, 0, ": the block of contact ", c, " is not zero and below ", smallest_scale,
            ", where its inverse overflows");
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < i; ++j) {
      const double product = d(i, i) * d(j, j);
      if (std::abs(d(i, j) - d(j, i)) > delassus_asymmetry * std::sqrt(product))
        fail_at(i, j, ": the block of contact ", c,
                " is further from symmetric than its diagonal is large");
      // A semidefinite block has no negative 2 x 2 minor: w_ij^2 <= w_ii w_jj.
      if (even(i, j) * even(i, j) > product * (1.0 + semidefinite_rounding))
        fail_at(i, j, ": the block of contact ", c, " is not positive semidefinite");
    }
  const double determinant = even.determinant();
  if (determinant < -semidefinite_rounding * d(0, 0) * d(1, 1) * d(2, 2))
    fail_at(0, 0, ": the block of contact ", c, " is not positive semidefinite (determinant ",
            determinant, ")");
}

void validate_delassus(const FrictionProblem& problem) {
  const SparseRows& w = problem.delassus.w;
  const int rows = problem.row_count();
  require_numbers("delassus.q", problem.delassus.q, rows, "one entry per contact row");
  require_size("delassus.w rows", static_cast<std::size_t>(w.rows()), rows, "the contacts");
  require_size("delassus.w columns", static_cast<std::size_t>(w.cols()), rows, "the contacts");
  for (int row = 0; row < rows; ++row) {
    // Columns must ascend: otherwise products and look-ups would go wrong silently.
    int previous = -1;
    for (SparseRows::InnerIterator entry(w, row); entry; ++entry) {
      const int column = static_cast<int>(entry.col());
      if (column <= previous || column >= rows)
        fail("delassus.w row ", row, " has column ", column, " after ", previous,
             "; columns ascend below ", rows);
      require_number(entry.value(), "delassus.w(", row, ", ", column, ")");
      previous = column;
    }
  }
  for (int c = 0; c < problem.contact_count(); ++c) validate_diagonal_block(problem, c);
}

}  // namespace

void FrictionProblem::validate(KnownMasses* valid, WorkerTeam* team) const {
  validate_contacts(*this);
  if (has_dynamics) {
    std::atomic<bool> are_valid = false, is_h_bad = false;  // the masses; some entry of H
    const auto look = [&](int begin, int end) {
      if (is_any_too_large(dynamics.h.data() + begin, end - begin)) is_h_bad = true;
    };
    run_ranges(team, static_cast<int>(dynamics.h.size()), /*together=*/8192, look,
               [&] { are_valid = valid && valid->has_masses_of(dynamics); });
    if (!are_valid) validate_masses(dynamics);
    if (!are_valid && valid) valid->keep(dynamics);
    validate_dynamics(*this, is_h_bad);
  }
  if (has_delassus) validate_delassus(*this);
  if (!has_dynamics && !has_delassus && contact_count() > 0)
    fail("has_dynamics = 0, has_delassus = 0: the problem of ", contact_count(),
         " contacts has neither form");
}

FrictionProblem local_problem(SparseRows&& w, Eigen::VectorXd q, std::vector<double> mu) {
  FrictionProblem problem;
  problem.friction = std::move(mu);
  for (int c = 0; c < problem.contact_count(); ++c) problem.row_begin.push_back(3 * (c + 1));
  problem.has_delassus = true;
  problem.delassus.w.swap(w);
  problem.delassus.w.makeCompressed();
  problem.delassus.q = std::move(q);
  return problem;
}

bool KnownMasses::has_masses_of(const DynamicsForm& dynamics) const {
  if (roots_.empty() || dof_begin_ != dynamics.dof_begin || mass_begin_ != dynamics.mass_begin ||
      dynamics.mass.size() != static_cast<std::size_t>(mass_begin_.back()))
    return false;
  const double* kept = mass_.data();
  std::uint64_t differing = 0;  // bits
  const auto bits = [](double x) { return std::bit_cast<std::uint64_t>(x); };
  for (int b = 0; b < dynamics.body_count(); ++b) {
    const double* block = dynamics.mass.data() + mass_begin_[b];
    const int dofs = roots_[b].dofs;
    for (int j = 0; j < dofs; ++j)
      for (int i = 0; i < dofs; ++i)
        differing |=
            bits(block[j * dofs + i]) ^ bits(i == j || !roots_[b].diagonal ? *kept++ : 0.0);
  }
  return differing == 0;
}

void KnownMasses::keep(const DynamicsForm& dynamics) {
  dof_begin_.clear();  // factor_masses may throw
  factor_masses(dynamics, roots_);
  dof_begin_ = dynamics.dof_begin;
  mass_begin_ = dynamics.mass_begin;
  mass_.clear();
  mass_.reserve(dynamics.dof_begin.back());
  for (int b = 0; b < dynamics.body_count(); ++b) {
    const int dofs = roots_[b].dofs, step = roots_[b].diagonal ? dofs + 1 : 1;
    for (int k = 0; k < dofs * dofs; k += step) mass_.push_back(dynamics.mass[mass_begin_[b] + k]);
  }
}

}  // namespace ballast
