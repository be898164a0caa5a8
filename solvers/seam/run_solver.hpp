#pragma once
// The only door to a solver that runs and benches use: validates, times, judges outside the
// stopwatch, and says what came of it.

#include <string>

#include "problems/algebra/contact_error.hpp"
#include "solvers/seam/solver.hpp"

namespace ballast {

struct SolverRun {
  Solved solved;
  ContactError error;          ///< the judge's, never the backend's
  double prepare_seconds = 0;  ///< wall clock of prepare(), and of solve() without its start-up
  double solve_seconds = 0;
  double startup_seconds = 0;  ///< of solve(): Solved::startup_seconds of all its rounds
  Verdict verdict = Verdict::unsolved;
  std::string failure;  ///< what() of the exception that a backend threw; empty: none

  bool is_solved() const { return verdict == Verdict::solved; }
};

/// Of impulses with that error, which a solver returned for that reason under that tolerance [m/s].
/// `by_fclib`: the tolerance is one of Siconos' measure (ContactError::fclib), which alone decides.
/// But it divides by |r|, so that what grows without bound meets it: that is no solution.
/// `began_large`: the start was about as large as the impulses, so their size proves nothing.
Verdict verdict_of(StopReason reason, const ContactError& error, double tolerance,
                   bool by_fclib = false, bool began_large = false);

/// What came of a run under that tolerance [m/s], in one line: "solved", "the judge denies it: -u_N
/// is 0.3 m/s (rms), at most 4e-08 may be", "no solution found; r grows without bound: ...". What
/// is not solved is searched for a proof that there is no solution, which changes the verdict
/// (look_for_no_solution: builds W, so never within a step).
/// The search has what the run left of max_seconds.
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

  /// Of the last run: what the judge found besides.
  const Eigen::VectorXd& body_velocity() const { return judge_.body_velocity(); }
  const Eigen::VectorXd& body_impulse() const { return judge_.body_impulse(); }

  /// A solver stops on the natural map. Where that is reached and another part of the law is not
  /// (much friction), it goes on from its answer to a smaller natural map, within the same budget.
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
