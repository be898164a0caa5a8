#pragma once
// The only door to a solver that runs and benches use: validates, times, and judges outside the stopwatch.

#include "problems/contact_error.hpp"
#include "solvers/solver.hpp"

namespace ballast {

struct SolverRun {
  Solved solved;
  ContactError error;          ///< the judge's, never the backend's
  double prepare_seconds = 0;  ///< wall clock of prepare() and solve() alone
  double solve_seconds = 0;
  bool success = false;  ///< the backend says reached_tolerance *and* the judge agrees
};

/// Keeps the judge's workspace between calls.
class SolverRunner {
 public:
  /// Throws InvalidProblem (before the solver sees it), UnsupportedProblem. A start of the wrong size is an
  /// InvalidProblem; an empty one means zero. Other exceptions of a backend become reason = numerical_failure.
  SolverRun run(Solver& solver, const FrictionProblem& problem, Impulses start, const Budget& budget);

 private:
  ContactJudge judge_;
};

}  // namespace ballast
