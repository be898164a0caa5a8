#pragma once
// One solve as a comparison wants it: to a tolerance in either measure, timed outside the judge,
// with its history.

#include "experiments/compare/compare_row.hpp"
#include "solvers/seam/run_solver.hpp"

namespace ballast {

struct DriveSettings {
  Measure measure = Measure::natural_map;
  double tolerance = 1e-8;       ///< in the measure
  double velocity_scale = 1.0;   ///< [m/s]
  double max_seconds = 60.0;     ///< prepare and all rounds
  int max_iterations = 1 << 30;  ///< of each round
};

struct DrivenSolve {
  SolverRun last;  ///< impulses and error at the end; its times are of the last round alone
  bool claimed = false;
  int iterations = 0, rounds = 0;
  double prepare_seconds = 0.0, solve_seconds = 0.0;  ///< of all rounds
  std::vector<HistoryRow> history;
  double seconds() const { return prepare_seconds + solve_seconds; }
};

/// natural_map: one solve. fclib: backends stop on the natural map, so the tolerance on it falls in
/// rounds, each started from the last one's impulses, until the judge's ContactError::fclib is
/// small enough; the rounds' times are added, the judge's not. The only place that does this.
/// Throws UnsupportedProblem, InvalidProblem, std::bad_alloc.
DrivenSolve drive_solver(Solver& solver, const FrictionProblem& problem, const Impulses& start,
                         const DriveSettings& settings);

}  // namespace ballast
