#pragma once
// k_art: how stiff a jam is that a solver leaves unfinished.
//
// In a jam no more force moves the driven wall: rigid grains carry it. A solver that has not
// carried the change through the packing by the end of the step lets the wall move, as though the
// packing were elastic:
//
//   k_art = dF / (h |dv|)    [N/m]
//
// dv: the wall's velocity after a step with the force raised by dF, minus that after the same step
// without, both from the impulses that the solver left before (a static load: what it would still
// have come closer by itself is in both). A wall that nothing holds has m_w / h^2. The exact answer
// of a jam has no bound, or the jam is about to give way.

#include "solvers/seam/run_solver.hpp"

namespace ballast {

/// dF as a part of the force on the wall.
inline constexpr double jam_load_step = 0.01;

/// `start`: the impulses that the solver left, at the present force. NaN without a driven wall or a
/// force on it; infinite where the wall does not stir. Throws what SolverRunner::run throws.
double jam_stiffness(Solver& solver, const FrictionProblem& problem, const Impulses& start,
                     const Budget& budget, double h);

}  // namespace ballast
