#include "solvers/backends/step_work.hpp"

#include <algorithm>

namespace ballast {
namespace {

/// A sweep over bodies: what it takes whatever the size, and per contact.
constexpr double small_sweep = 2000.0, body_visit = 40.0;
/// A sweep over a stored W: the same, and per entry; a contact's own solution is the most of it.
constexpr double small_matrix_sweep = 1000.0, matrix_entry = 1.0, matrix_visit = 60.0;
/// Anderson's mixing: its sweep over one without.
constexpr double mixing_bodies = 2.5, mixing_matrix = 1.6;
/// A Newton step over bodies: linearisation, assembly and line search per contact, right-hand sides
/// per unknown, and of the factorisation per operation. Before those are known it is taken for
/// fill: as much as the right-hand sides for so many unknowns.
constexpr double body_contact = 1000.0, body_unknown = 25.0, front_operation = 0.12;
constexpr double filled_unknowns = 20.0;
/// The step of Coulomb's law takes a line search and a refinement more.
constexpr double coulomb = 1.65;
/// The same of a stored W (newton_step.hpp): dense where rows are few or W is nearly full, with
/// half of the contacts pressed until it is known which are. A sparse factorisation is mostly
/// bookkeeping, row by row.
constexpr double few_rows = 200.0, nearly_full = 0.1, matrix_contact = 1700.0;
constexpr double dense_entry = 8.0, dense_cube = 0.026, dense_operation = 0.63;
constexpr double sparse_row = 3400.0, filled_rows = 900.0;
/// An interior point's step over Newton's.
constexpr double interior = 2.0;
/// Sweeps that cost as much as a factorisation that is dear.
constexpr double dear_step = 120.0;

}  // namespace

void StepWork::count(const FrictionProblem& problem) {
  contacts_ = problem.contact_count();
  has_bodies_ = problem.has_dynamics;
  is_learnt_ = false;
  mixed_after_ = 0.5;
  if (has_bodies_) {
    unknowns_ = problem.dynamics.dof_count();
    sweep_ = small_sweep + body_visit * contacts_;
    step_ =
        body_contact * contacts_ + body_unknown * unknowns_ * (1.0 + unknowns_ / filled_unknowns);
    if (step_ < dear_step * sweep_) mixed_after_ = 2.0;
    return;
  }
  const double rows = problem.row_count();
  const double entries = static_cast<double>(problem.delassus.w.nonZeros());
  sweep_ = small_matrix_sweep + matrix_entry * entries + matrix_visit * contacts_;
  const bool is_dense = rows <= few_rows || entries > nearly_full * rows * rows;
  const double dense = dense_entry * entries + dense_cube * rows * rows * rows;
  const double sparse = sparse_row * rows * (1.0 + rows / filled_rows);
  step_ = matrix_contact * contacts_ + (is_dense ? std::min(dense, sparse) : sparse);
}

bool StepWork::learn(double operations) {
  if (is_learnt_ || !has_bodies_ || operations == 0.0) return false;
  is_learnt_ = true;
  step_ = body_contact * contacts_ + body_unknown * unknowns_ + front_operation * operations;
  return true;
}

double StepWork::mixed_sweep() const {
  return (has_bodies_ ? mixing_bodies : mixing_matrix) * sweep_;
}
double StepWork::newton_step() const { return (has_bodies_ ? coulomb : 1.0) * step_; }
double StepWork::interior_step() const { return interior * newton_step(); }
double StepWork::stored_step(double operations) const {
  return matrix_contact * contacts_ + dense_operation * operations;
}

}  // namespace ballast
