// FrictionProblem::validate(): fast loops look for any bad entry; only when there is one is it
// looked for again, to name it.

#include <bit>
#include <cmath>
#include <cstdint>
#include <sstream>
#include <string>

#include "platform/for_each_cpu.hpp"
#include "problems/algebra/delassus.hpp"
#include "problems/algebra/known_masses.hpp"
#include "problems/algebra/mass_root.hpp"

namespace ballast {
namespace {

/// Asymmetry |x_ij - x_ji| of a block, relative to its diagonal. Masses: rounding of rotated
/// inertias. Stored Delassus operators: implicit gyroscopic terms make some of them truly
/// unsymmetric (FCLIB's RockPile by 2 %, others by 16 %), and the law is asked of W as it is; only
/// a block whose antisymmetric part outweighs its diagonal is taken for something else.
constexpr double mass_asymmetry = 1e-10;
constexpr double delassus_asymmetry = 2.0;
/// Below zero by this much, relative, a minor of a stored block is taken for rounding: some files
/// hold six digits.
constexpr double semidefinite_rounding = 1e-5;

template <typename... Parts>
[[noreturn]] void fail(const Parts&... parts) {
  std::ostringstream text;
  text.precision(17);
  (text << ... << parts);
  throw InvalidProblem(text.str());
}

void require_size(const char* array, long size, long expected, const char* because) {
  if (size != expected) fail(array, " has ", size, " entries; ", because, " needs ", expected);
}

/// Numbers >= 0 are ordered as their bits are, infinity and NaN after all others. Integer work, so
/// that the compiler vectorises the reduction.
BALLAST_FOR_EACH_CPU bool is_any_too_large(const double* x, long size) {
  constexpr std::uint64_t magnitude = 0x7fffffffffffffffull;
  constexpr std::uint64_t largest = std::bit_cast<std::uint64_t>(largest_entry);
  std::uint64_t bad = 0;
  // As integers, `largest` minus anything larger, infinite or NaN is negative: its top bit is set.
  for (long i = 0; i < size; ++i)
    bad |= (largest - (std::bit_cast<std::uint64_t>(x[i]) & magnitude)) >> 63;
  return bad != 0;
}

void require_finite(const char* array, const double* x, long size) {
  if (!is_any_too_large(x, size)) return;
  for (long i = 0; i < size; ++i) {
    if (!std::isfinite(x[i])) fail(array, "[", i, "] = ", x[i], " is not finite");
    if (std::abs(x[i]) > largest_entry)
      fail(array, "[", i, "] = ", x[i], " is beyond ", largest_entry,
           ", where squares and products overflow");
  }
}

void require_begin(const char* array, const std::vector<int>& begin, int count, const char* of) {
  require_size(array, static_cast<long>(begin.size()), count + 1L, of);
  if (begin[0] != 0) fail(array, "[0] = ", begin[0], ", must be 0");
}

// Sizes first: what follows may then index freely.
void validate_contacts(const FrictionProblem& problem) {
  const int contacts = problem.contact_count();
  require_begin("row_begin", problem.row_begin, contacts, "one friction coefficient per contact");
  require_finite("friction", problem.friction.data(), contacts);
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

// Positive definite and, up to rounding, symmetric.
void validate_mass_block(const DynamicsForm& dynamics, int b) {
  const int dofs = dynamics.body_dofs(b), first = dynamics.mass_begin[b];
  const double* block = dynamics.mass.data() + first;
  // A Cholesky factor exists exactly where the block is positive definite.
  MassRoot root;
  if (!root.factor(block, dofs))
    fail("dynamics.mass[", first, "] = ", block[0], ": the block of body ", b,
         " is not positive definite");
  for (int j = 0; j < dofs; ++j)
    if (block[j * dofs + j] < smallest_scale)
      fail("dynamics.mass[", first + j * dofs + j, "] = ", block[j * dofs + j], " is below ",
           smallest_scale, ", where its inverse overflows");
  for (int j = 0; j < dofs; ++j)
    for (int i = j + 1; i < dofs; ++i) {
      const double lower = block[j * dofs + i], upper = block[i * dofs + j];
      if (lower == upper) continue;
      if (std::abs(lower - upper) >
          mass_asymmetry * std::sqrt(block[j * dofs + j] * block[i * dofs + i]))
        fail("dynamics.mass[", first + i * dofs + j, "] = ", upper, ": the block of body ", b,
             " is not symmetric");
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
  require_size("dynamics.mass", static_cast<long>(dynamics.mass.size()), dynamics.mass_begin.back(),
               "mass_begin");
  require_finite("dynamics.mass", dynamics.mass.data(), dynamics.mass_begin.back());
  for (int b = 0; b < bodies; ++b) validate_mass_block(dynamics, b);
}

/// `valid`: masses that are known; may be null.
void validate_bodies(const DynamicsForm& dynamics, KnownMasses* valid) {
  if (!valid || !valid->are_of(dynamics)) {
    validate_masses(dynamics);
    if (valid) valid->keep(dynamics);
  }
  require_size("dynamics.v_free", dynamics.v_free.size(), dynamics.dof_count(),
               "one entry per unknown");
  require_finite("dynamics.v_free", dynamics.v_free.data(), dynamics.v_free.size());
}

void validate_dynamics(const FrictionProblem& problem, KnownMasses* valid) {
  const DynamicsForm& dynamics = problem.dynamics;
  validate_bodies(dynamics, valid);
  const int contacts = problem.contact_count(), bodies = dynamics.body_count();
  require_size("dynamics.body_a", static_cast<long>(dynamics.body_a.size()), contacts,
               "one entry per contact");
  require_size("dynamics.body_b", static_cast<long>(dynamics.body_b.size()), contacts,
               "one entry per contact");
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
  require_size("dynamics.h", static_cast<long>(dynamics.h.size()), dynamics.h_begin.back(),
               "h_begin");
  require_finite("dynamics.h", dynamics.h.data(), dynamics.h_begin.back());
  require_size("dynamics.bias", dynamics.bias.size(), problem.row_count(),
               "one entry per contact row");
  require_finite("dynamics.bias", dynamics.bias.data(), dynamics.bias.size());
}

// Positive semidefinite up to rounding: all minors of the symmetric part.
void validate_diagonal_block(const FrictionProblem& problem, int c) {
  const Eigen::Matrix3d d = stored_diagonal_block(problem, c), even = 0.5 * (d + d.transpose());
  const int first = problem.row_begin[c];
  for (int i = 0; i < 3; ++i)
    if (d(i, i) < 0.0)
      fail("delassus.w(", first + i, ", ", first + i, ") = ", d(i, i), " is negative");
  const double largest = d.diagonal().maxCoeff();
  if (largest > 0.0 && largest < smallest_scale)
    fail("delassus.w(", first, ", ", first, ") = ", d(0, 0), ": the block of contact ", c,
         " is not zero and below ", smallest_scale, ", where its inverse overflows");
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < i; ++j) {
      const double product = d(i, i) * d(j, j);
      if (std::abs(d(i, j) - d(j, i)) > delassus_asymmetry * std::sqrt(product))
        fail("delassus.w(", first + i, ", ", first + j, ") = ", d(i, j), ": the block of contact ",
             c, " is further from symmetric than its diagonal is large");
      // A semidefinite block has no negative 2 x 2 minor: w_ij^2 <= w_ii w_jj.
      if (even(i, j) * even(i, j) > product * (1.0 + semidefinite_rounding))
        fail("delassus.w(", first + i, ", ", first + j, ") = ", d(i, j), ": the block of contact ",
             c, " is not positive semidefinite");
    }
  const double determinant = even.determinant();
  if (determinant < -semidefinite_rounding * d(0, 0) * d(1, 1) * d(2, 2))
    fail("delassus.w(", first, ", ", first, ") = ", d(0, 0), ": the block of contact ", c,
         " is not positive semidefinite (determinant ", determinant, ")");
}

void validate_delassus(const FrictionProblem& problem) {
  const SparseRows& w = problem.delassus.w;
  const int rows = problem.row_count();
  require_size("delassus.q", problem.delassus.q.size(), rows, "one entry per contact row");
  require_finite("delassus.q", problem.delassus.q.data(), rows);
  require_size("delassus.w rows", w.rows(), rows, "the contacts");
  require_size("delassus.w columns", w.cols(), rows, "the contacts");
  for (int row = 0; row < rows; ++row) {
    // Columns ascend, without which products and look-ups would go wrong silently.
    int previous = -1;
    for (SparseRows::InnerIterator entry(w, row); entry; ++entry) {
      const int column = static_cast<int>(entry.col());
      if (column <= previous || column >= rows)
        fail("delassus.w row ", row, " has column ", column, " after ", previous,
             "; columns ascend below ", rows);
      if (!std::isfinite(entry.value()))
        fail("delassus.w(", row, ", ", column, ") = ", entry.value(), " is not finite");
      if (std::abs(entry.value()) > largest_entry)
        fail("delassus.w(", row, ", ", column, ") = ", entry.value(), " is beyond ", largest_entry,
             ", where squares and products overflow");
      previous = column;
    }
  }
  for (int c = 0; c < problem.contact_count(); ++c) validate_diagonal_block(problem, c);
}

void validate_all(const FrictionProblem& problem, KnownMasses* valid) {
  validate_contacts(problem);
  if (problem.has_dynamics) validate_dynamics(problem, valid);
  if (problem.has_delassus) validate_delassus(problem);
  if (!problem.has_dynamics && !problem.has_delassus && problem.contact_count() > 0)
    fail("has_dynamics = 0, has_delassus = 0: the problem of ", problem.contact_count(),
         " contacts has neither form");
}

}  // namespace

void FrictionProblem::validate() const { validate_all(*this, nullptr); }

void validate(const FrictionProblem& problem, KnownMasses& valid) { validate_all(problem, &valid); }

}  // namespace ballast
