#pragma once
// The outer loop of backends that call a foreign solver again and again until the judge is content
// with its answer.

#include <functional>

#include "solvers/seam/moving_contacts.hpp"
#include "solvers/seam/solver.hpp"

namespace ballast {

struct RoundRequest {
  const Eigen::VectorXd& last;  ///< where the last round ended, rows of MovingContacts
  const Eigen::VectorXd& best;  ///< the iterate of least error so far
  double last_error;            ///< of `last`, by the judge [m/s]
  Budget left;                  ///< max_iterations > 0
};

struct RoundAnswer {
  Eigen::VectorXd x;      ///< not finite or empty: the round failed, and nothing is taken from it
  int iterations = 1;     ///< what the round cost; 1 at least is booked
  double seconds = -1.0;  ///< wall clock of the foreign solver's own work; the rest of the round is
                          ///< start-up. Negative: all of the round is its work
  bool finished = true;   ///< ended by its own criterion, not by a limit: a failure to improve
                          ///< counts as standing still
};

/// Rounds until the judge's error of the best iterate, which is what is returned, meets the budget;
/// `stalled` when `patience` finished rounds in a row brought no tenth of improvement. The judge is
/// asked after every round; its time is start-up.
Solved solve_in_rounds(const FrictionProblem& problem, const MovingContacts& moving, Impulses start,
                       const Budget& budget, int patience,
                       const std::function<void(const RoundRequest&, RoundAnswer&)>& round);

}  // namespace ballast
