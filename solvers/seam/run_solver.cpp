#include "solvers/seam/run_solver.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "platform/clock.hpp"
#include "platform/text.hpp"
#include "problems/algebra/no_solution.hpp"

namespace ballast {
namespace {

/// With a `growth` of a judged answer beyond this, r counts as growing without bound.
constexpr double unbounded_growth = 1e8;

/// Makes an empty start zero. Throws InvalidProblem, naming the entry.
void validate_start(const FrictionProblem& problem, Impulses& start) {
  if (start.size() == 0) start.setZero(problem.row_count());
  if (start.size() != problem.row_count())
    throw InvalidProblem("start has " + std::to_string(start.size()) +
                         " entries, the contacts have " + std::to_string(problem.row_count()) +
                         " rows");
  for (Eigen::Index i = 0; i < start.size(); ++i)
    if (!(std::abs(start[i]) <= largest_entry))
      throw InvalidProblem(
          printed("start[%ld] = %g is ", static_cast<long>(i), start[i]) +
          (std::isfinite(start[i]) ? printed("beyond %g", largest_entry) : "not finite"));
}

/// Names the first part of the law that the answer misses.
std::string what_is_missed(const ContactError& error, double tolerance) {
  if (!error.finite) return "the impulses, or velocities that they give, are not finite";
  const auto missed = [](const char* part, double value, double bound) {
    return printed("%s is %.3g m/s (rms), at most %.3g may be", part, value, bound);
  };
  const double bound = ContactError::bound_factor * tolerance;
  if (!(error.natural_map_rms <= tolerance))
    return missed("the natural map", error.natural_map_rms, tolerance);
  if (!(error.approach_rms <= bound)) return missed("-u_N", error.approach_rms, bound);
  if (!(error.cone_rms <= bound))
    return missed("the distance of r from its cones", error.cone_rms, bound);
  return missed("the complementarity of r and u", error.complementarity_rms, bound);
}

}  // namespace

Verdict verdict_of(StopReason reason, const ContactError& error, double tolerance, bool by_fclib,
                   bool began_large) {
  const bool claimed = reason == StopReason::reached_tolerance;
  const bool grows = error.finite && error.growth > unbounded_growth;
  if (by_fclib ? error.finite && error.fclib <= tolerance && !grows : error.within(tolerance))
    return claimed ? Verdict::solved : Verdict::unsolved;
  // No solution: no impulse helps, or the impulses have left every scale of the problem. Siconos'
  // tolerance is a pure number; the approach of contacts is measured in m/s.
  const double approach = by_fclib ? tolerance * error.velocity_scale : tolerance;
  const bool sinks = error.finite && error.immovable_approach > approach;
  if (sinks || (grows && !began_large)) return Verdict::no_solution;
  // A tolerance of 0 asks for no accuracy, so there is no claim to deny.
  return claimed && tolerance > 0.0 ? Verdict::denied : Verdict::unsolved;
}

std::string explained(const FrictionProblem& problem, SolverRun& run, double tolerance,
                      double max_seconds) {
  if (run.is_solved()) return "solved";
  constexpr int sweeps = 500;
  const double left = max_seconds - run.prepare_seconds - run.startup_seconds - run.solve_seconds;
  const NoSolutionProof proof = prove_no_solution(problem, run.solved.impulses, sweeps, left);
  // An approach below the tolerance is no proof.
  if (proof.proved() && proof.approach > tolerance) {
    run.verdict = Verdict::no_solution;
    return proof.words();
  }
  if (run.verdict == Verdict::unsolved)
    return std::string("unsolved: ") + name_of(run.solved.reason) +
           (run.failure.empty() ? "" : ": " + run.failure);
  if (run.verdict == Verdict::denied)
    return "the judge denies it: " + what_is_missed(run.error, tolerance);
  if (run.error.immovable_approach > tolerance)
    return printed("no solution found; a contact that no impulse moves sinks in at %.3g m/s",
                   run.error.immovable_approach);
  return printed("no solution found; r grows without bound: %.3g times what a contact alone needs",
                 run.error.growth);
}

/// Calls the solver once within `left`. Whatever impulses it returns are judged, from the impulses
/// alone and outside the stopwatch. Gives no verdict.
SolverRun SolverRunner::attempt(Solver& solver, const FrictionProblem& problem, Impulses start,
                                const Budget& left, bool prepares) {
  SolverRun run;
  Stopwatch watch;
  try {
    if (prepares) solver.prepare(problem);
    if (prepares) run.prepare_seconds = watch.restart();
    run.solved = solver.solve(problem, std::move(start), left.after(0, run.prepare_seconds));
    const double all = watch.seconds();
    run.startup_seconds = std::min(run.solved.startup_seconds, all);
    run.solve_seconds = all - run.startup_seconds;
  } catch (const UnsupportedProblem&) {
    throw;
  } catch (const LostProcess&) {
    throw;
  } catch (const std::exception& error) {
    run.solved = {};
    run.solved.reason = StopReason::numerical_failure;
    run.failure = error.what();
    run.solve_seconds = watch.seconds();
  }
  // A backend that failed may return nothing: zero impulses are judged then.
  if (run.solved.impulses.size() != problem.row_count()) {
    run.solved.impulses.setZero(problem.row_count());
    run.solved.reason = StopReason::numerical_failure;
  }
  run.error = judge_.judge(problem, run.solved.impulses, /*masses_are_known=*/true);
  return run;
}

SolverRun SolverRunner::run(Solver& solver, const FrictionProblem& problem, Impulses start,
                            const Budget& budget) {
  problem.validate(&judge_.masses(), team_);
  validate_start(problem, start);
  constexpr double much = 10.0;  // up to this many times the start is no growth
  const double much_larger = much * start.lpNorm<Eigen::Infinity>();
  const auto decide = [&](SolverRun& run) {
    const bool began_large = run.error.growth > unbounded_growth &&
                             run.solved.impulses.lpNorm<Eigen::Infinity>() <= much_larger;
    run.verdict = verdict_of(run.solved.reason, run.error,
                             budget.fclib ? budget.fclib->tolerance() : budget.tolerance,
                             budget.fclib != nullptr, began_large);
  };
  SolverRun run = attempt(solver, problem, std::move(start), budget, true);
  decide(run);
  if (budget.fclib) return run;  // its measure alone decides
  // Rounds to smaller natural maps while the solver reaches its tolerance but misses other parts of
  // the law. Impulses that leave every scale end them: no solver helps then.
  constexpr int most_rounds = 6;
  constexpr double aim = 0.5, largest_fall = 1e-3;  // of the bound; of the natural map in a round
  double target = budget.tolerance;
  for (int round = 0; round < most_rounds && run.verdict == Verdict::denied; ++round) {
    const ContactError& error = run.error;
    if (!error.finite || error.natural_map_rms > budget.tolerance) break;
    // The target falls by the factor by which the worst part is above `aim` times its bound.
    const double worst = std::max({error.approach_rms, error.cone_rms, error.complementarity_rms});
    const double ratio = ContactError::bound_factor * budget.tolerance / worst;
    target = std::min(target, error.natural_map_rms) * std::max(aim * ratio, largest_fall);
    Budget left = budget.after(run.solved.iterations, run.prepare_seconds + run.solve_seconds);
    if (left.max_iterations < 1 || !(left.max_seconds > 0.0)) {
      run.solved.reason =
          left.max_iterations < 1 ? StopReason::iteration_limit : StopReason::time_limit;
      decide(run);
      break;
    }
    if (!(target > 0.0)) break;
    left.tolerance = target;
    SolverRun next = attempt(solver, problem, run.solved.impulses, left, false);
    if (!next.failure.empty() || !(next.error.natural_map_rms <= budget.tolerance)) {
      // worse than what it began with
      next.solved.impulses = run.solved.impulses;
      next.error = judge_.judge(problem, next.solved.impulses, /*masses_are_known=*/true);
    }
    decide(next);
    // The tolerance of the budget decides. Both attempts are booked as one solve.
    if (next.error.within(budget.tolerance)) {
      next.solved.reason = StopReason::reached_tolerance;
      next.verdict = Verdict::solved;
    }
    run.solved.go_on(std::move(next.solved), run.solve_seconds);
    next.solved = std::move(run.solved);
    next.prepare_seconds = run.prepare_seconds;
    next.solve_seconds += run.solve_seconds;
    next.startup_seconds += run.startup_seconds;
    run = std::move(next);
  }
  return run;
}

}  // namespace ballast
