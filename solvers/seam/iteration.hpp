#pragma once
// The bookkeeping that backends share: when to evaluate the error, why to stop, history.

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>
#include <vector>

#include "platform/clock.hpp"
#include "solvers/seam/solver.hpp"

namespace ballast {

/// The bookkeeping of one solve: budget, clock, iterations, history. The constructor starts it.
class SolveBook {
 public:
  explicit SolveBook(const Budget& budget) : budget_(budget) {}

  int count() const { return count_; }  ///< number of iterations
  double seconds() const { return watch_.seconds() - startup_; }
  bool is_late() const {
    return watch_.has_passed(budget_.max_seconds + startup_) ||
           (budget_.is_cancelled && budget_.is_cancelled());
  }
  /// Returns whether `error` [m/s] is small enough to stop.
  bool reached(double error) const { return error <= budget_.tolerance * (1.0 - stop_margin); }
  /// Books `seconds` of the past time as start-up (Solved::startup_seconds): neither limits nor
  /// history count them.
  void add_startup(double seconds) { startup_ += seconds; }

 protected:
  /// Returns why the solve stops at an iterate of this error; nothing: it goes on. `is_enough`: the
  /// iterate satisfies what the budget asks for; `is_late`: the time is over.
  std::optional<StopReason> reason_to_stop(double error, bool is_enough, bool is_late) const;
  /// Takes an iterate's error. The first one is the start's.
  void see(double error) {
    if (std::isnan(start_error_)) start_error_ = error;
  }
  /// Returns the result of the backend; moves the history out.
  Solved closed(Impulses impulses, StopReason reason, double error);

  Budget budget_;
  int count_ = 0;
  std::vector<HistoryPoint> history_;

 private:
  Stopwatch watch_;
  double startup_ = 0.0, start_error_ = std::numeric_limits<double>::quiet_NaN();
};

/// When to evaluate the error: after `first` iterations, then each time after `growth` times as
/// many, or `growth_far` times while the last error was above far * Budget::aim(). In a sweeping
/// method an evaluation costs more than an iteration, and its moment matters only near the end.
struct CheckSchedule {
  static constexpr double far = 8.0;
  int first = 1;
  double growth = 1.0;
  double growth_far = growth;
};

/// Use:  evaluated(error, r);  while (next()) { one iteration; if (is_error_due()) evaluated(error,
/// r); } finish(std::move(r));
class Iteration : public SolveBook {
 public:
  /// If no digit of the error changes in so many iterations, it never will: the solve is stalled.
  static constexpr int stalled_after = 1000;

  Iteration(const Budget& budget, const CheckSchedule& schedule)
      : SolveBook(budget), schedule_(schedule), next_check_(schedule.first) {}

  /// Begins the next iteration. False: a reason to stop was found; the error of the current iterate
  /// is then known.
  bool next();
  /// Returns whether the iterate must be evaluated: by schedule, or because a limit is reached and
  /// finish() must report the error of the last iterate.
  bool is_error_due();
  /// True: evaluated(error) will find a reason to stop: the error, the iterations or the time.
  bool ends_with(double error) const {
    return reached(error) || count_ >= budget_.max_iterations || out_of_time_;
  }
  bool is_over() const { return reason_.has_value(); }  ///< a reason to stop was found
  /// Takes the scaled natural map (rms) of the current iterate `r`, records it, and decides whether
  /// to stop. `r` is read only if the budget asks for another measure.
  void evaluated(double error, const Impulses& r);
  /// Returns the result of the backend: `impulses` with the reason, count, error and history.
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

/// The course of one solve whose error may rise in between, or that runs several solvers one after
/// the other. It keeps the best iterate and returns it.
///
/// Use: run() a solver from the best iterate, or spend() iterations and offer() every iterate whose
/// error was evaluated, until over(); then finish().
class Course : public SolveBook {
 public:
  /// `start` is the first best iterate.
  Course(const Budget& budget, Impulses start) : SolveBook(budget), best_(std::move(start)) {}

  /// Runs `solver`, prepared for `problem`, from the best iterate for at most `most_iterations` or
  /// until it `gives_up` (Budget). Keeps its result if that is better than the best iterate, or if
  /// the solver has reached what the budget asks for; then the course is over.
  void run(Solver& solver, const FrictionProblem& problem, int most_iterations,
           decltype(Budget::gives_up) gives_up = {});
  /// The same for a solver that is prepared when it is first needed. Does nothing if the course is
  /// over.
  void run(LazySolver& way, const FrictionProblem& problem, double most_iterations) {
    if (!over())
      run(way.prepared(problem), problem, static_cast<int>(std::min(most_iterations, 1e9)));
  }

  void spend(int iterations) { count_ += iterations; }
  /// Takes an iterate with its error, evaluated from the impulses alone [m/s]. Keeps it if it is
  /// the best, or if it satisfies the other measure that the budget asks for.
  void offer(const Impulses& r, double error);

  const Impulses& best() const { return best_; }
  double error() const { return error_; }         ///< of the best [m/s]; 1e300 before it is known
  int idle() const { return count_ - best_at_; }  ///< iterations since the best was found
  /// True if the best error is small enough to stop or nothing is left of the budget.
  bool over() const { return end().has_value(); }
  /// The rest of the budget without Budget::gives_up, which counts from the beginning of a solve.
  Budget rest() const;

  /// The best iterate with counts and the history of the best error; `stalled` where neither the
  /// tolerance nor a limit was reached.
  Solved finish();

 private:
  static constexpr double unknown = 1e300;

  std::optional<StopReason> end() const { return reason_to_stop(error_, is_enough_, is_late()); }
  void remember(int iterations, double seconds, double error);

  double error_ = unknown;
  int best_at_ = 0;         ///< count() when the best was found
  bool is_enough_ = false;  ///< the best satisfies what the budget asks for
  Impulses best_;
};

}  // namespace ballast
