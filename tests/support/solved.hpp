#pragma once
// Gives a problem to a solver once, as most tests of solvers do.

#include <memory>

#include "solvers/seam/run_solver.hpp"

namespace ballast {

/// The solver's answer, from no impulses.
inline Solved from_rest(Solver& solver, const FrictionProblem& problem, const Budget& budget) {
  solver.prepare(problem);
  return solver.solve(problem, Impulses::Zero(problem.row_count()), budget);
}

/// The solver's answer with the judge's result, from `start` or no impulses.
inline SolverRun judged_by(std::unique_ptr<Solver> solver, const FrictionProblem& problem,
                           const Budget& budget, const Impulses& start = {}) {
  return SolverRunner().run(*solver, problem, start, budget);
}

/// The rms over rows of q [m/s], the scale for errors.
inline double velocity_scale(const FrictionProblem& problem) {
  return contact_error(problem, Impulses::Zero(problem.row_count())).velocity_scale;
}

}  // namespace ballast
