#include "solvers/backends/step_work.hpp"

#include <algorithm>

namespace ballast {
namespace {

/// A sweep over bodies, per contact.
constexpr double body_visit = 40.0;
/// A sweep over a stored W, per entry and per contact: the contact's own solution.
constexpr double matrix_entry = 1.0, matrix_visit = 60.0;
/// What a sweep takes besides, whatever the size.
constexpr double small_sweep = 1000.0;
/// Anderson's mixing: its sweep over one without.
constexpr double mixing_bodies = 2.5, mixing_matrix = 1.6;
/// A Newton step: linearisation and line search per contact, assembly per unknown, and of the
/// factorisation per operation. Before those are known it is taken for the fill of packings: as
/// much as the assembly for so many unknowns.
constexpr double newton_contact = 750.0, body_unknown = 500.0, front_operation = 0.25;
constexpr double filled_unknowns = 500.0;
/// Over bodies the step of Coulomb's law takes a line search and a refinement more.
constexpr double coulomb = 2.5;
/// The same of a stored W (newton_matrix.hpp): dense where rows are few or W is nearly full, with
/// half of the contacts pressed until it is known which are. A sparse factorisation is mostly
/// bookkeeping, row by row.
constexpr double few_rows = 200.0, nearly_full = 0.1;
constexpr double dense_entry = 8.0, dense_cube = 0.015, dense_operation = 0.45;
constexpr double sparse_row = 1500.0, filled_rows = 600.0;
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
        newton_contact * contacts_ + body_unknown * unknowns_ * (1.0 + unknowns_ / filled_unknowns);
    if (step_ < dear_step * sweep_) mixed_after_ = 2.0;
    return;
  }
  const double rows = problem.row_count();
  const double entries = static_cast<double>(problem.delassus.w.nonZeros());
  sweep_ = small_sweep + matrix_entry * entries + matrix_visit * contacts_;
  const bool is_dense = rows <= few_rows || entries > nearly_full * rows * rows;
  const double dense = dense_entry * entries + dense_cube * rows * rows * rows;
  const double sparse = sparse_row * rows * (1.0 + rows / filled_rows);
  step_ = newton_contact * contacts_ + (is_dense ? std::min(dense, sparse) : sparse);
}

bool StepWork::learn(double operations) {
  if (is_learnt_ || !has_bodies_ || operations == 0.0) return false;
  is_learnt_ = true;
  step_ = newton_contact * contacts_ + body_unknown * unknowns_ + front_operation * operations;
  return true;
}

double StepWork::mixed_sweep() const {
  return (has_bodies_ ? mixing_bodies : mixing_matrix) * sweep_;
}
double StepWork::newton_step() const { return (has_bodies_ ? coulomb : 1.0) * step_; }
double StepWork::interior_step() const { return interior * step_; }
double StepWork::stored_step(double operations) const {
  return newton_contact * contacts_ + dense_operation * operations;
}

}  // namespace ballast
