#include "solvers/seam/course.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "solvers/seam/fclib_stop.hpp"
#include "solvers/seam/iteration.hpp"
#include "solvers/seam/relay.hpp"

namespace ballast {

Course::Course(const Budget& budget, Impulses start, double error)
    : budget_(budget), error_(error), best_(std::move(start)) {
  is_enough_ = budget_.fclib && budget_.fclib->reached(best_, error_);
  remember();
}

Course::Course(const Budget& budget, Solver& first, const FrictionProblem& problem, Impulses start,
               const std::function<bool(int, double)>& leave)
    : budget_(budget), best_(start) {
  const LeaveRule either = [&](int iterations, double error, const Impulses& r) {
    leaves_ = budget.leave && (*budget.leave)(iterations, error, r);
    return leaves_ || leave(iterations, error);
  };
  Budget whole = budget;
  whole.keep_history = true;
  whole.leave = &either;
  Solved opened = first.solve(problem, std::move(start), whole);
  error_ = opened.history.front().error;
  join(opened.history, 0, 0.0);
  iterations_ = opened.iterations;
  is_enough_ = opened.reason == StopReason::reached_tolerance;
  if (!is_enough_ && !(opened.own_residual < error_)) return;
  error_ = opened.own_residual;
  best_ = std::move(opened.impulses);
}

void Course::offer(const Impulses& r, double error) {
  // The other measure may be reached where the error is not the smallest.
  const bool is_enough = budget_.fclib && !is_enough_ && budget_.fclib->reached(r, error);
  if (is_enough || (error < error_ && !is_enough_)) {
    error_ = error;
    best_ = r;
  }
  is_enough_ = is_enough_ || is_enough;
  remember();
  if (budget_.leave && !reached() && (*budget_.leave)(iterations_, error_, best_)) leaves_ = true;
}

void Course::factor_by(Solver& solver, const FrictionProblem& problem, int most) {
  const int before = iterations_, factorised = budget_.factorisations ? *budget_.factorisations : 0;
  const double began = watch_.seconds();
  const auto count = [&](int iterations) {
    if (budget_.factorisations) *budget_.factorisations = factorised + iterations;
  };
  const LeaveRule leave = [&](int iterations, double error, const Impulses& r) {
    count(iterations);
    const bool is_best = error < error_;
    leaves_ = (*budget_.leave)(before + iterations, is_best ? error : error_, is_best ? r : best_);
    return leaves_;
  };
  Budget left = rest();
  left.max_iterations = std::min(left.max_iterations, most);
  left.keep_history = true;  // its last point is the error that it came to
  if (budget_.leave) left.leave = &leave;
  Solved part = solver.solve(problem, best_, left);
  count(part.iterations);
  join(part.history, before, began);
  iterations_ += part.iterations;
  offer(part.impulses, part.history.back().error);
}

/// The history of a part that began after so many iterations and seconds. The errors are those of
/// the best.
void Course::join(const std::vector<HistoryPoint>& part, int iterations, double seconds) {
  if (!budget_.keep_history) return;
  for (const HistoryPoint& point : part) {
    const double error =
        history_.empty() ? point.error : std::min(history_.back().error, point.error);
    history_.push_back({iterations + point.iteration, seconds + point.seconds, error});
  }
}

/// One point per count of iterations, the last one that was true of it.
void Course::remember() {
  if (!budget_.keep_history) return;
  if (!history_.empty() && history_.back().iteration == iterations_) history_.pop_back();
  history_.push_back({iterations_, watch_.seconds(), error_});
}

bool Course::reached() const {
  return is_enough_ || error_ <= budget_.tolerance * (1.0 - Iteration::margin);
}

bool Course::over() const {
  return reached() || leaves_ || !std::isfinite(error_) || iterations_ >= budget_.max_iterations ||
         watch_.seconds() >= budget_.max_seconds;
}

Budget Course::rest() const {
  Budget rest = rest_of(budget_, iterations_, watch_.seconds());
  rest.leave = nullptr;  // it counts the iterations of the whole course
  return rest;
}

Solved Course::finish() {
  remember();
  Solved solved;
  solved.reason = StopReason::stalled;
  if (!std::isfinite(error_))
    solved.reason = StopReason::numerical_failure;
  else if (reached())
    solved.reason = StopReason::reached_tolerance;
  else if (iterations_ >= budget_.max_iterations)
    solved.reason = StopReason::iteration_limit;
  else if (watch_.seconds() >= budget_.max_seconds)
    solved.reason = StopReason::time_limit;
  solved.impulses = std::move(best_);
  solved.iterations = iterations_;
  solved.own_residual = error_;
  solved.history = std::move(history_);
  return solved;
}

}  // namespace ballast
