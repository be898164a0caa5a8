#pragma once
// One solve as a relay: several solvers, one after the other, each from where the others have come
// and within what they have left of one budget.

#include <functional>

#include "platform/clock.hpp"

#include "solvers/seam/solver.hpp"

namespace ballast {

/// `whole` after so many iterations and seconds were spent of it; never less than nothing.
Budget rest_of(const Budget& whole, int iterations, double seconds);

/// Use:  Relay relay(budget, start);  relay.run(one, ...);  if (!relay.over()) relay.run(other,
/// ...); return relay.finish();
class Relay {
 public:
  /// One solver's leg: from `start`, with `left` to spend. What it returns has a history.
  using Leg = std::function<Solved(Impulses start, const Budget& left)>;

  /// The clock of the whole starts here.
  Relay(const Budget& budget, Impulses start);

  /// Runs a leg from the best iterate so far. The better of the two is kept, as a leg may end worse
  /// than it began; or the one that reached what was asked. Returns the error of the best [m/s].
  double run(const Leg& leg);
  /// `solver`, prepared for `problem`, for at most so many iterations.
  double run(Solver& solver, const FrictionProblem& problem, int most_iterations);

  /// The last leg reached the tolerance, a leg failed, or nothing is left of the budget.
  bool over() const;
  int iterations() const { return solved_.iterations; }
  double error() const {
    return error_;
  }  ///< of the best iterate [m/s]; 1e300 before the first leg

  /// The best iterate, with counts, clock and history of all legs; `stalled` where neither the
  /// tolerance nor a limit was reached.
  Solved finish();

 private:
  double seconds() const;
  void book_history(const std::vector<HistoryPoint>& leg, double began);

  Budget budget_;
  Stopwatch watch_;
  Solved solved_;
  double error_ = 1e300;
  bool reached_ = false, failed_ = false;
};

}  // namespace ballast
