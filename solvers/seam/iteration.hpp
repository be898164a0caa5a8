#pragma once
// The bookkeeping that backends share: budget, clock, when to look at the error, why to stop,
// history.

#include <utility>
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

/// The course of one solve whose method wanders, or is several solvers, one after the other: it may
/// leave its best iterate for a worse one and come back, and returns the best.
///
/// Use: run() a solver from the best iterate, or spend() iterations and offer() every iterate that
/// was judged, until over(); then finish().
class Course {
 public:
  /// A solver's part: from `start`, with `left` to spend. What it returns has a history, whose
  /// first point is the error at `start`. `reached_tolerance` says that the course is over.
  using Part = std::function<Solved(Impulses start, Budget left)>;

  /// The clock starts here. `start` is the best so far.
  Course(const Budget& budget, Impulses start)
      : budget_(budget), error_(unknown), best_(std::move(start)) {}

  /// One part, from the best iterate. Its end is kept if it is better, or has reached what was
  /// asked.
  void run(const Part& part);
  /// `solver`, prepared for `problem`, for at most so many iterations.
  void run(Solver& solver, const FrictionProblem& problem, int most_iterations);

  void spend(int iterations) { iterations_ += iterations; }
  /// An iterate with its error, evaluated from the impulses alone [m/s]. Kept if it is the best, or
  /// where it satisfies the other measure that the budget asks for.
  void offer(const Impulses& r, double error);

  const Impulses& best() const { return best_; }
  double error() const { return error_; }  ///< of the best [m/s]; 1e300 before it is known
  int iterations() const { return iterations_; }
  int idle() const { return iterations_ - best_at_; }  ///< iterations since the best was found
  /// The best is small enough to stop, or nothing is left of the budget.
  bool over() const;
  /// What is left, without Budget::gives_up, which counts from the beginning.
  Budget rest() const;

  /// The best iterate with counts and the history of the best error; `stalled` where neither the
  /// tolerance nor a limit was reached.
  Solved finish();

 private:
  static constexpr double unknown = 1e300;

  bool reached() const;
  double seconds() const { return watch_.seconds() - startup_; }
  void remember(int iterations, double seconds, double error);

  Budget budget_;
  Stopwatch watch_;
  int iterations_ = 0;
  double error_, startup_ = 0.0;
  int best_at_ = 0;         ///< iterations
  bool is_enough_ = false;  ///< the best satisfies what the budget asks for
  Impulses best_;
  std::vector<HistoryPoint> history_;
};

}  // namespace ballast
