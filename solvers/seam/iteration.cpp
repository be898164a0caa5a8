#include "solvers/seam/iteration.hpp"

#include <algorithm>
#include <cmath>

namespace ballast {

std::optional<StopReason> SolveBook::reason_to_stop(double error, bool is_enough,
                                                    bool is_late) const {
  // The strongest reason first.
  if (!std::isfinite(error)) return StopReason::numerical_failure;
  if (is_enough || reached(error)) return StopReason::reached_tolerance;
  if (count_ >= budget_.max_iterations) return StopReason::iteration_limit;
  if (is_late) return StopReason::time_limit;
  return std::nullopt;
}

Solved SolveBook::closed(Impulses impulses, StopReason reason, double error) {
  return {.impulses = std::move(impulses),
          .reason = reason,
          .iterations = count_,
          .own_residual = error,
          .start_error = start_error_,
          .end_error = error,
          .startup_seconds = startup_,
          .history = std::move(history_)};
}

bool Iteration::next() {
  if (reason_) return false;
  ++count_;
  return true;
}

bool Iteration::is_error_due() {
  // Once the time is over the iterate must be judged, and it is the last.
  out_of_time_ = is_late();
  return count_ >= next_check_ || count_ >= budget_.max_iterations || out_of_time_;
}

void Iteration::evaluated(double error, const Impulses& r) {
  const bool is_enough = budget_.fclib && budget_.fclib->reached(r, error);
  // Record the point, and since when no digit of the error has changed.
  see(error);
  if (budget_.keep_history) history_.push_back({count_, seconds(), error});
  if (!(error == error_)) unchanged_since_ = count_;
  error_ = error;
  // The next evaluation is later by the factor for the present distance from the aim.
  const bool is_far = error > CheckSchedule::far * budget_.aim();
  const double growth = is_far ? schedule_.growth_far : schedule_.growth;
  while (next_check_ <= count_)
    next_check_ = std::max(next_check_ + 1, static_cast<int>(std::ceil(next_check_ * growth)));

  reason_ = reason_to_stop(error, is_enough, out_of_time_ || is_late());
  if (!reason_ && (count_ - unchanged_since_ >= stalled_after ||
                   (budget_.gives_up && budget_.gives_up(count_, error))))
    reason_ = StopReason::stalled;
}

void Course::run(Solver& solver, const FrictionProblem& problem, int most_iterations,
                 decltype(Budget::gives_up) gives_up) {
  const int before = count_;
  const double began = seconds();
  Budget left = budget_.after(before, began);
  left.max_iterations = std::min(most_iterations, left.max_iterations);
  left.gives_up = std::move(gives_up);
  // The solver works on a copy: the best iterate may have to stay.
  Solved done = solver.solve(problem, best_, left);
  if (error_ == unknown && !std::isnan(done.start_error)) {
    error_ = done.start_error;
    see(error_);
  }
  for (const HistoryPoint& point : done.history)
    remember(before + point.iteration, began + point.seconds, point.error);
  spend(done.iterations);
  add_startup(done.startup_seconds);
  const double error = done.end_error;
  const bool is_enough = done.reason == StopReason::reached_tolerance;
  if (!is_enough && !(error < error_)) return;
  is_enough_ = is_enough_ || is_enough;
  error_ = error;
  best_at_ = count_;
  best_ = std::move(done.impulses);
}

void Course::offer(const Impulses& r, double error) {
  see(error);
  // The other measure may be reached where the error is not the smallest. With an error of zero it
  // need not be evaluated.
  const bool is_asked = budget_.fclib && !is_enough_ && error > 0.0;
  const bool is_enough = is_asked && budget_.fclib->reached(r, error);
  if (is_enough || ((error < error_ || error_ == unknown) && !is_enough_)) {
    error_ = error;
    best_at_ = count_;
    best_ = r;
  }
  is_enough_ = is_enough_ || is_enough;
  if (budget_.keep_history) remember(count_, seconds(), error_);
}

/// Keeps one point for each count of iterations, the last one given; errors are the best so far.
void Course::remember(int iterations, double seconds, double error) {
  if (!history_.empty()) {
    error = std::min(error, history_.back().error);
    if (history_.back().iteration == iterations) history_.pop_back();
  }
  history_.push_back({iterations, seconds, error});
}

Budget Course::rest() const {
  Budget rest = budget_.after(count_, seconds());
  rest.gives_up = {};
  return rest;
}

Solved Course::finish() {
  const bool is_told = !history_.empty() && history_.back().iteration == count_;
  if (budget_.keep_history && !is_told) remember(count_, seconds(), error_);
  return closed(std::move(best_), end().value_or(StopReason::stalled), error_);
}

}  // namespace ballast
