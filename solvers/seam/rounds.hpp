#pragma once
// What foreign solvers are handed, the problem in impulses alone without the contacts that no
// impulse moves, and the outer loop that calls them again and again until the judge is content.

#include <functional>
#include <vector>

#include "solvers/seam/solver.hpp"

namespace ballast {

/// The entries of w in these rows and these columns.
SparseRows chosen(const SparseRows& w, const std::vector<int>& row);

/// u = w r + q over the contacts kept, in the problem's order. The others (W_cc = 0: both bodies
/// fixed) have any impulse for a solution; they get zero.
struct MovingContacts {
  std::vector<int> contact;       ///< number in the problem of each contact kept
  std::vector<int> row_begin{0};  ///< rows of contact k here; size kept + 1
  std::vector<double> friction;
  std::vector<double> lambda_max;  ///< of W_cc, > 0 [1/kg]
  SparseRows w;                    ///< as it is: a stored one may be unsymmetric
  Eigen::VectorXd q;
  std::vector<int> row;  ///< in the problem, of each row here
  int problem_rows = 0;

  void take(const FrictionProblem& problem);
  void gather(const Impulses& r, Eigen::VectorXd& x) const { x = r(row); }
  /// Contacts that were not kept become zero.
  void scatter(const Eigen::VectorXd& x, Impulses& r) const {
    r.setZero(problem_rows);
    r(row) = x;
  }

  int contact_count() const { return static_cast<int>(contact.size()); }
  int row_count() const { return row_begin.back(); }
  int rows(int k) const { return row_begin[k + 1] - row_begin[k]; }
};

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

/// `call` in a child process (platform/program.hpp), as it may crash, hang or leak; here
/// where this process is a comparison's child, which may be lost and stays warm. Of the answer x,
/// iterations and seconds come back. False: there is none within what is `left`, or the solve was
/// cancelled.
bool answer_apart(const Budget& left, const std::function<bool(RoundAnswer&)>& call,
                  RoundAnswer& answer);

/// Rounds until the judge's error of the best iterate, which is what is returned, meets the budget;
/// `stalled` when `patience` finished rounds in a row brought no tenth of improvement. The judge is
/// asked after every round; its time is start-up.
Solved solve_in_rounds(const FrictionProblem& problem, const MovingContacts& moving, Impulses start,
                       const Budget& budget, int patience,
                       const std::function<void(const RoundRequest&, RoundAnswer&)>& round);

}  // namespace ballast
