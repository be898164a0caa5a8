#include "experiments/compare/drive_solver.hpp"

#include <optional>

namespace ballast {

DrivenSolve drive_solver(Solver& solver, const FrictionProblem& problem, const Impulses& start,
                         const DriveSettings& settings) {
  // The natural map has no say where another measure is asked for.
  std::optional<FclibStop> fclib;
  Budget budget{.tolerance = 0.0,
                .max_iterations = settings.max_iterations,
                .max_seconds = settings.max_seconds,
                .keep_history = true};
  if (settings.measure == Measure::fclib)
    budget.fclib = &fclib.emplace(problem, settings.tolerance);
  else
    budget.tolerance = settings.tolerance * settings.velocity_scale;

  DrivenSolve driven;
  driven.run = SolverRunner().run(solver, problem, start, budget);
  for (const HistoryPoint& point : driven.run.solved.history)
    driven.history.push_back(
        {point.iteration, point.seconds, point.error / settings.velocity_scale});
  return driven;
}

}  // namespace ballast
