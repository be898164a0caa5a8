#include "solvers/seam/run_solver.hpp"

#include <cmath>
#include <new>
#include <string>
#include <utility>

#include "platform/clock.hpp"
#include "solvers/seam/fclib_stop.hpp"

namespace ballast {
namespace {

/// Empty means zero. Throws InvalidProblem, naming the entry.
void validate_start(const FrictionProblem& problem, Impulses& start) {
  if (start.size() == 0) start.setZero(problem.row_count());
  if (start.size() != problem.row_count())
    throw InvalidProblem("start has " + std::to_string(start.size()) +
                         " entries, the contacts have " + std::to_string(problem.row_count()) +
                         " rows");
  if (start.allFinite()) return;
  for (Eigen::Index i = 0; i < start.size(); ++i)
    if (!std::isfinite(start[i]))
      throw InvalidProblem("start[" + std::to_string(i) + "] = " + std::to_string(start[i]) +
                           " is not finite");
}

}  // namespace

/// Does the timed work, then judges what it left in run.solved, whatever that is.
template <typename Work>
SolverRun SolverRunner::guarded(const FrictionProblem& problem, const Budget& budget, Work&& work) {
  SolverRun run;
  try {
    work(run);
  } catch (const UnsupportedProblem&) {
    throw;
  } catch (const std::exception& error) {
    run.solved = {};
    run.solved.reason = StopReason::numerical_failure;
    run.failure = error.what();
  }
  // A backend that failed may return nothing; no impulses is then what is judged.
  if (run.solved.impulses.size() != problem.row_count()) {
    run.solved.impulses.setZero(problem.row_count());
    run.solved.reason = StopReason::numerical_failure;
  }
  // Outside the stopwatch, from the impulses alone.
  run.error = judge_.judge(problem, run.solved.impulses);
  const bool is_small = budget.fclib ? run.error.fclib <= budget.fclib->tolerance()
                                     : run.error.natural_map_rms <= budget.tolerance;
  run.success = run.solved.reason == StopReason::reached_tolerance && run.error.finite && is_small;
  return run;
}

SolverRun SolverRunner::run(Solver& solver, const FrictionProblem& problem, Impulses start,
                            const Budget& budget) {
  problem.validate();
  validate_start(problem, start);
  return guarded(problem, budget, [&](SolverRun& run) {
    Stopwatch watch;
    solver.prepare(problem);
    run.prepare_seconds = watch.seconds();
    watch.restart();
    run.solved = solver.solve(problem, std::move(start), budget);
    run.startup_seconds = run.solved.startup_seconds;
    run.solve_seconds = watch.seconds() - run.startup_seconds;
  });
}

SolverRun SolverRunner::run_again(Solver& solver, const FrictionProblem& problem, Impulses start,
                                  const Budget& budget) {
  validate_start(problem, start);
  return guarded(problem, budget, [&](SolverRun& run) {
    const Stopwatch watch;
    run.solved = solver.solve(problem, std::move(start), budget);
    run.startup_seconds = run.solved.startup_seconds;
    run.solve_seconds = watch.seconds() - run.startup_seconds;
  });
}

}  // namespace ballast
