#pragma once
// The only way in which runs and benches call a solver: validates the problem, times the solver,
// judges its answer outside the stopwatch, and gives the verdict.

#include <string>

#include "problems/algebra/contact_error.hpp"
#include "solvers/seam/solver.hpp"

namespace ballast {

struct SolverRun {
  Solved solved;
  ContactError error;          ///< the judge's, never the backend's
  double prepare_seconds = 0;  ///< wall clock of prepare()
  double solve_seconds = 0;    ///< wall clock of solve() without its start-up
  double startup_seconds = 0;  ///< of solve(): Solved::startup_seconds of all its rounds
  Verdict verdict = Verdict::unsolved;
  std::string failure;  ///< what() of the exception that a backend threw; empty: none

  bool is_solved() const { return verdict == Verdict::solved; }
};

/// The verdict on impulses with `error` that a solver returned for `reason` under `tolerance`
/// [m/s]. `by_fclib`: the tolerance is one on Siconos' measure (ContactError::fclib), which alone
/// decides; but it divides by |r|, so impulses that grow without bound meet it: they are no
/// solution. `began_large`: the start was about as large as they are, so their size proves nothing.
Verdict verdict_of(StopReason reason, const ContactError& error, double tolerance,
                   bool by_fclib = false, bool began_large = false);

/// Returns one line on the result of a run under `tolerance` [m/s]: "solved", "the judge denies it:
/// -u_N is 0.3 m/s (rms), at most 4e-08 may be", "no solution found; r grows without bound: ...".
/// For a run that is not solved it searches a proof that there is no solution, within what the run
/// left of max_seconds, and a proof changes the verdict (prove_no_solution: builds W, so never
/// call this within a step).
std::string explained(const FrictionProblem& problem, SolverRun& run, double tolerance,
                      double max_seconds = 1e30);

/// Keeps the judge's workspace between calls.
class SolverRunner {
 public:
  /// Shares the validation's and the judge's work (ContactJudge::use_team). Solvers have
  /// Solver::use_team.
  void use_team(WorkerTeam* team) {
    team_ = team;
    judge_.use_team(team);
  }

  /// The body velocities and impulses that the judge computed in the last run.
  const Eigen::VectorXd& body_velocity() const { return judge_.body_velocity(); }
  const Eigen::VectorXd& body_impulse() const { return judge_.body_impulse(); }

  /// Runs `solver`, which stops on the natural map. If its answer misses another part of the law
  /// (much friction), it goes on from there to a smaller natural map, within the same budget.
  ///
  /// Throws InvalidProblem (before the solver sees it), UnsupportedProblem, LostProcess. A start of
  /// the wrong size, or with an entry beyond largest_entry, is an InvalidProblem; an empty one
  /// means zero. Other exceptions of a backend become reason = numerical_failure.
  SolverRun run(Solver& solver, const FrictionProblem& problem, Impulses start,
                const Budget& budget);

 private:
  SolverRun attempt(Solver& solver, const FrictionProblem& problem, Impulses start,
                    const Budget& left, bool prepares);

  WorkerTeam* team_ = nullptr;
  ContactJudge judge_;
};

}  // namespace ballast
