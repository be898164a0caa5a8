#pragma once
// The problem that foreign solvers get, in impulses alone and without the contacts that no impulse
// moves, and the outer loop that calls a foreign solver until the judge's error meets the budget.

#include <functional>
#include <vector>

#include "solvers/seam/solver.hpp"

namespace ballast {

/// Returns the entries of w in the rows `row` and the same columns.
SparseRows chosen(const SparseRows& w, const std::vector<int>& row);

/// u = w r + q over the contacts kept, in the problem's order. Any impulse solves the others
/// (W_cc = 0: both bodies fixed); they get zero.
struct ReducedProblem {
  const FrictionProblem* whole = nullptr;  ///< given to take(); must outlive the use of this one
  std::vector<int> contact;                ///< number in the problem of each contact kept
  std::vector<int> row_begin{0};           ///< rows of contact k here; size kept + 1
  std::vector<double> friction;
  std::vector<double> lambda_max;  ///< of W_cc, > 0 [1/kg]
  SparseRows w;                    ///< as the problem gives it: a stored W may be unsymmetric
  Eigen::VectorXd q;
  std::vector<int> row;  ///< number in the problem of each row here

  void take(const FrictionProblem& problem);
  /// Contacts that were not kept become zero.
  void scatter(const Eigen::VectorXd& x, Impulses& r) const {
    r.setZero(whole->row_count());
    r(row) = x;
  }

  int contact_count() const { return static_cast<int>(contact.size()); }
  int row_count() const { return row_begin.back(); }
  int rows(int k) const { return row_begin[k + 1] - row_begin[k]; }
};

struct RoundRequest {
  const Eigen::VectorXd& last;  ///< where the last round ended, rows of ReducedProblem
  const Eigen::VectorXd& best;  ///< the iterate of least error so far
  double last_error;            ///< of `last`, by the judge [m/s]
  Budget left;                  ///< max_iterations > 0
};

struct RoundAnswer {
  Eigen::VectorXd x;      ///< not finite or empty: the round failed, and x is ignored
  int iterations = 1;     ///< of the round; at least 1 is booked
  double seconds = -1.0;  ///< wall clock of the foreign solver's own work; the rest of the round is
                          ///< start-up. Negative: all of the round is its work
  bool finished = true;   ///< ended by its own criterion, not by a limit: then a round without
                          ///< improvement counts towards `patience`
};

/// Runs `call` in a child process (platform/program.hpp), as it may crash, hang or leak; in this
/// process if it is a comparison's child, which may be lost and stays warm. Of the answer, x,
/// iterations and seconds come back. False: no answer came within `left`, or the solve was
/// cancelled.
bool answer_apart(const Budget& left, const std::function<bool(RoundAnswer&)>& call,
                  RoundAnswer& answer);

/// Calls `round` until the judge's error of the best iterate meets the budget, and returns that
/// iterate; `stalled` when `patience` finished rounds after another bring no tenth less error. The
/// judge evaluates every round's result; its time is start-up.
Solved solve_in_rounds(const ReducedProblem& moving, Impulses start, const Budget& budget,
                       int patience,
                       const std::function<void(const RoundRequest&, RoundAnswer&)>& round);

}  // namespace ballast
