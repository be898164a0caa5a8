#pragma once
// The course of one solve whose method wanders: it may leave its best iterate for a worse one, and
// come back. (A Relay always goes on from the best.)

#include <vector>

#include "platform/clock.hpp"
#include "solvers/seam/solver.hpp"

namespace ballast {

/// Use:  offer() every iterate that was judged, spend() every iteration, until over(); then
/// finish().
class Course {
 public:
  /// The clock starts here. `start` is the best so far, `error` its error [m/s].
  Course(const Budget& budget, Impulses start, double error);
  /// The clock starts here, and `first`, prepared for `problem`, opens the course from `start`
  /// until `leave` (Budget) says that it is enough. It judges the start as well.
  Course(const Budget& budget, Solver& first, const FrictionProblem& problem, Impulses start,
         const std::function<bool(int, double)>& leave);

  void spend(int iterations) { iterations_ += iterations; }
  /// One iteration that was a factorisation.
  void factored() {
    spend(1);
    if (budget_.factorisations) ++*budget_.factorisations;
  }
  /// An iterate with its error, evaluated from the impulses alone [m/s]. Kept if it is the best, or
  /// where it satisfies the other measure that the budget asks for.
  void offer(const Impulses& r, double error);

  /// `solver`, prepared for `problem`, goes on from the best for at most so many iterations, each
  /// of which is one factorisation.
  void factor_by(Solver& solver, const FrictionProblem& problem, int most);

  const Impulses& best() const { return best_; }
  double error() const { return error_; }  ///< of the best [m/s]
  /// The best is small enough to stop, nothing is left of the budget, or whoever gave it has
  /// something better to do with the rest (Budget::leave).
  bool over() const;
  /// What is left, without Budget::leave: that is asked here.
  Budget rest() const;

  /// The best iterate with counts and history; `stalled` where neither the tolerance nor a limit
  /// was reached.
  Solved finish();

 private:
  bool reached() const;
  void join(const std::vector<HistoryPoint>& part, int iterations, double seconds);
  void remember();

  Budget budget_;
  Stopwatch watch_;
  int iterations_ = 0;
  double error_;
  bool is_enough_ = false;  ///< the best satisfies the budget's other measure
  bool leaves_ = false;     ///< Budget::leave said so
  Impulses best_;
  std::vector<HistoryPoint> history_;  ///< of the best error
};

}  // namespace ballast
