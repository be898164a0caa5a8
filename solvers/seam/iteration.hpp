#pragma once
// The bookkeeping that every iterative backend shares: budget, clock, when to look at the error,
// why to stop, history.

#include <vector>

#include "platform/clock.hpp"

#include "solvers/seam/solver.hpp"

namespace ballast {

/// When the error is evaluated: at `first`, and then after `growth` times as many iterations;
/// `growth_far` while it was last above `far` tolerances. Of a sweeping method an evaluation costs
/// more than an iteration, and only near the end does it matter when.
struct CheckSchedule {
  static constexpr double far = 8.0;
  int first = 1;
  double growth = 1.0;
  double growth_far = growth;
};

/// Use:  evaluated(error, r);  while (next()) { one iteration; if (error_due()) evaluated(error,
/// r); } finish(std::move(r));
class Iteration {
 public:
  /// Iterations without any digit of the error changing, after which it never will.
  static constexpr int stalled_after = 1000;

  /// `patience`: in place of stalled_after, where an iteration is something smaller.
  Iteration(const Budget& budget, const CheckSchedule& schedule, int patience = stalled_after);

  /// Opens the next iteration. False when a reason to stop was found: the error of the current
  /// iterate is then known.
  bool next();
  /// True when the iterate must be evaluated: by schedule, or because a limit is reached and the
  /// last error must be its own.
  bool error_due();
  /// Small enough to stop. A hair below the tolerance, because the judge sums in another order than
  /// a backend does.
  bool reached(double error) const { return error <= budget_.tolerance * (1.0 - margin); }
  /// True: evaluated(error) will find a reason to stop, be it the number of iterations or the time.
  bool ends_with(double error) const {
    return reached(error) || count_ >= budget_.max_iterations || out_of_time_;
  }
  /// Takes the scaled natural map (rms) of the current iterate `r`, records it, and decides. `r` is
  /// read where the budget asks for another measure.
  void evaluated(double error, const Impulses& r);
  /// So much of the time that has passed was start-up (Solved::startup_seconds): no limit and no
  /// history counts it.
  void add_startup(double seconds) { startup_ += seconds; }

  int count() const { return count_; }
  double seconds() const;
  /// What a backend returns: `impulses`, with the reason, count, error and history, which are moved
  /// out.
  Solved finish(Impulses impulses);

  static constexpr double margin = 1e-3;

 private:
  Budget budget_;
  CheckSchedule schedule_;
  Stopwatch watch_;
  int count_ = 0;
  int next_check_, patience_;
  bool stopped_ = false, out_of_time_ = false;
  StopReason reason_ = StopReason::numerical_failure;
  double error_;
  int unchanged_since_ = 0;
  double startup_ = 0.0;
  std::vector<HistoryPoint> history_;
};

}  // namespace ballast
