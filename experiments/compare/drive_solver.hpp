#pragma once
// One solve as a comparison wants it: to a tolerance in either measure, timed outside the judge,
// with its history.

#include <functional>
#include <memory>

#include "experiments/compare/compare_row.hpp"
#include "solvers/seam/run_solver.hpp"

namespace ballast {

/// Makes a backend of solver_list(), a test's own, or one that starts a program.
using MakeSolver = std::function<std::unique_ptr<Solver>()>;

struct DriveSettings {
  Measure measure = Measure::natural_map;
  double tolerance = 1e-8;      ///< in the measure
  double velocity_scale = 1.0;  ///< [m/s]
  double max_seconds = 60.0;    ///< prepare and solve, start-up apart
  int max_iterations = 1 << 30;
};

struct DrivenSolve {
  SolverRun run;  ///< impulses and error at the end
  std::vector<HistoryRow> history;
  double seconds() const { return run.prepare_seconds + run.solve_seconds; }
};

/// One solve, which stops on the measure that is asked for: every backend looks at it wherever it
/// evaluates its error (Budget::fclib). Throws UnsupportedProblem, InvalidProblem, std::bad_alloc.
DrivenSolve drive_solver(Solver& solver, const FrictionProblem& problem, const Impulses& start,
                         const DriveSettings& settings);

}  // namespace ballast
