#pragma once
// The bookkeeping that backends share: budget, clock, when to look at the error, why to stop,
// history.

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>
#include <vector>

#include "platform/clock.hpp"
#include "solvers/seam/solver.hpp"

namespace ballast {

/// What every solve books: its budget, its clock, iterations, history. The clock starts here.
class SolveBook {
 public:
  explicit SolveBook(const Budget& budget) : budget_(budget) {}

  int count() const { return count_; }  ///< of iterations
  double seconds() const { return watch_.seconds() - startup_; }
  bool is_late() const {
    return watch_.has_passed(budget_.max_seconds + startup_) ||
           (budget_.is_cancelled && budget_.is_cancelled());
  }
  /// Small enough to stop [m/s].
  bool reached(double error) const { return error <= budget_.tolerance * (1.0 - stop_margin); }
  /// So much of the time that has passed was start-up (Solved::startup_seconds): no limit and no
  /// history counts it.
  void add_startup(double seconds) { startup_ += seconds; }

 protected:
  /// Nothing: the solve goes on from an iterate of this error. `is_enough`: it satisfies what the
  /// budget asks for; `is_late`: the time is over.
  std::optional<StopReason> reason_to_stop(double error, bool is_enough, bool is_late) const;
  /// Of an iterate's error: the first is the start's.
  void see(double error) {
    if (std::isnan(start_error_)) start_error_ = error;
  }
  /// What a backend returns; the history is moved out.
  Solved closed(Impulses impulses, StopReason reason, double error);

  Budget budget_;
  int count_ = 0;
  std::vector<HistoryPoint> history_;

 private:
  Stopwatch watch_;
  double startup_ = 0.0, start_error_ = std::numeric_limits<double>::quiet_NaN();
};

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
class Iteration : public SolveBook {
 public:
  /// Iterations without any digit of the error changing, after which it never will.
  static constexpr int stalled_after = 1000;

  Iteration(const Budget& budget, const CheckSchedule& schedule)
      : SolveBook(budget), schedule_(schedule), next_check_(schedule.first) {}

  /// Opens the next iteration. False when a reason to stop was found: the error of the current
  /// iterate is then known.
  bool next();
  /// True when the iterate must be evaluated: by schedule, or because a limit is reached and the
  /// last error must be its own.
  bool error_due();
  /// True: evaluated(error) will find a reason to stop, be it the number of iterations or the time.
  bool ends_with(double error) const {
    return reached(error) || count_ >= budget_.max_iterations || out_of_time_;
  }
  bool is_over() const { return reason_.has_value(); }  ///< a reason to stop was found
  /// Takes the scaled natural map (rms) of the current iterate `r`, records it, and decides. `r` is
  /// read where the budget asks for another measure.
  void evaluated(double error, const Impulses& r);
  /// What a backend returns: `impulses`, with the reason, count, error and history.
  Solved finish(Impulses impulses) {
    return closed(std::move(impulses), reason_.value_or(StopReason::numerical_failure), error_);
  }

 private:
  CheckSchedule schedule_;
  int next_check_, unchanged_since_ = 0;
  bool out_of_time_ = false;
  std::optional<StopReason> reason_;
  double error_ = std::numeric_limits<double>::quiet_NaN();
};

/// The course of one solve whose method wanders, or is several solvers, one after the other: it may
/// leave its best iterate for a worse one and come back, and returns the best.
///
/// Use: run() a solver from the best iterate, or spend() iterations and offer() every iterate that
/// was judged, until over(); then finish().
class Course : public SolveBook {
 public:
  /// `start` is the best so far.
  Course(const Budget& budget, Impulses start) : SolveBook(budget), best_(std::move(start)) {}

  /// `solver`, prepared for `problem`, from the best iterate, for at most so many iterations and
  /// until it `gives_up` (Budget). Its end is kept if it is better, or has reached what was asked,
  /// with which the course is over.
  void run(Solver& solver, const FrictionProblem& problem, int most_iterations,
           decltype(Budget::gives_up) gives_up = {});
  /// The same of a solver that is prepared when it is first needed; nothing where the course is
  /// over.
  void run(LateSolver& way, const FrictionProblem& problem, double most_iterations) {
    if (!over())
      run(way.prepared(problem), problem, static_cast<int>(std::min(most_iterations, 1e9)));
  }

  void spend(int iterations) { count_ += iterations; }
  /// An iterate with its error, evaluated from the impulses alone [m/s]. Kept if it is the best, or
  /// where it satisfies the other measure that the budget asks for.
  void offer(const Impulses& r, double error);

  const Impulses& best() const { return best_; }
  double error() const { return error_; }         ///< of the best [m/s]; 1e300 before it is known
  int idle() const { return count_ - best_at_; }  ///< iterations since the best was found
  /// The best is small enough to stop, or nothing is left of the budget.
  bool over() const { return end().has_value(); }
  /// What is left, without Budget::gives_up, which counts from the beginning.
  Budget rest() const;

  /// The best iterate with counts and the history of the best error; `stalled` where neither the
  /// tolerance nor a limit was reached.
  Solved finish();

 private:
  static constexpr double unknown = 1e300;

  std::optional<StopReason> end() const { return reason_to_stop(error_, is_enough_, is_late()); }
  void remember(int iterations, double seconds, double error);

  double error_ = unknown;
  int best_at_ = 0;         ///< iterations
  bool is_enough_ = false;  ///< the best satisfies what the budget asks for
  Impulses best_;
};

}  // namespace ballast
