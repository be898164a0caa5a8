#pragma once
// The only door to a solver that runs and benches use: validates, times, and judges outside the
// stopwatch.

#include "problems/algebra/contact_error.hpp"
#include "solvers/seam/solver.hpp"
#include "solvers/seam/verdict.hpp"

namespace ballast {

struct SolverRun {
  Solved solved;
  ContactError error;          ///< the judge's, never the backend's
  double prepare_seconds = 0;  ///< wall clock of prepare() and solve() alone
  double solve_seconds = 0;
  double startup_seconds = 0;    ///< of solve(), and not in solve_seconds: Solved::startup_seconds
  double processor_seconds = 0;  ///< of this process in prepare() and solve(), start-up included
  Verdict verdict = Verdict::unsolved;
  bool success = false;  ///< verdict == solved
  std::string failure;   ///< what() of the exception that a backend threw; empty: none
};

/// Keeps the judge's workspace between calls.
class SolverRunner {
 public:
  /// Shares the judge's work (ContactJudge::use_team). Solvers have Solver::use_team.
  void use_team(WorkerTeam* team) { judge_.use_team(team); }

  /// Of the last run: what the judge found besides.
  const Eigen::VectorXd& body_velocity() const { return judge_.body_velocity(); }
  const Eigen::VectorXd& body_impulse() const { return judge_.body_impulse(); }

  /// A solver stops on the natural map. Where that is reached and another part of the law is not
  /// (much friction), it goes on from its answer to a smaller natural map, within the same budget.
  ///
  /// Throws InvalidProblem (before the solver sees it), UnsupportedProblem, LostProcess. A start of
  /// the wrong size is an InvalidProblem; an empty one means zero. Other exceptions of a backend
  /// become reason = numerical_failure.
  SolverRun run(Solver& solver, const FrictionProblem& problem, Impulses start,
                const Budget& budget);

 private:
  template <typename Work>
  SolverRun guarded(const FrictionProblem& problem, const Budget& budget, Work&& work);
  SolverRun until_within(Solver& solver, const FrictionProblem& problem, const Budget& budget,
                         SolverRun run);

  ContactJudge judge_;
  KnownMasses masses_;  // that were validated
};

}  // namespace ballast
