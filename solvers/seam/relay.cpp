#include "solvers/seam/relay.hpp"

#include <algorithm>
#include <utility>

#include "platform/clock.hpp"

namespace ballast {

Budget rest_of(const Budget& whole, int iterations, double seconds) {
  Budget rest = whole;
  rest.max_iterations = std::max(0, whole.max_iterations - iterations);
  rest.max_seconds = std::max(0.0, whole.max_seconds - seconds);
  return rest;
}

Relay::Relay(const Budget& budget, Impulses start) : budget_(budget) {
  solved_.impulses = std::move(start);
  solved_.reason = StopReason::stalled;
}

double Relay::seconds() const { return watch_.seconds() - solved_.startup_seconds; }

double Relay::run(const Leg& leg) {
  const double began = seconds();
  Budget left = rest_of(budget_, solved_.iterations, began);
  left.keep_history = true;  // its last point is the error that the leg came to
  // The leg works on a copy: the best iterate may have to stay.
  Solved part = leg(solved_.impulses, left);
  const double error = part.history.empty() ? error_ : part.history.back().error;
  book_history(part.history, began);
  solved_.iterations += part.iterations;
  solved_.own_residual = part.own_residual;
  solved_.startup_seconds += part.startup_seconds;
  reached_ = part.reason == StopReason::reached_tolerance;
  // Another measure than the error may be what was reached.
  if (reached_ || !(error > error_)) {
    solved_.impulses = std::move(part.impulses);
    error_ = error;
  } else if (!solved_.history.empty()) {
    solved_.history.back().error = error_;  // of the iterate that is kept
  }
  if (part.reason == StopReason::numerical_failure) failed_ = true;
  return error_;
}

double Relay::run(Solver& solver, const FrictionProblem& problem, int most_iterations) {
  return run([&](Impulses start, Budget left) {
    left.max_iterations = std::min(most_iterations, left.max_iterations);
    return solver.solve(problem, std::move(start), left);
  });
}

/// Counted from the beginning of the whole. A leg's first point is where the one before ended; a
/// better one without an iteration between them takes its place.
void Relay::book_history(const std::vector<HistoryPoint>& leg, double began) {
  if (!budget_.keep_history) return;
  for (const HistoryPoint& point : leg) {
    if (point.iteration == 0 && !solved_.history.empty()) {
      if (!(point.error < solved_.history.back().error)) continue;
      solved_.history.pop_back();
    }
    solved_.history.push_back(
        {solved_.iterations + point.iteration, began + point.seconds, point.error});
  }
}

bool Relay::over() const {
  return reached_ || failed_ || solved_.iterations >= budget_.max_iterations ||
         seconds() >= budget_.max_seconds;
}

Solved Relay::finish() {
  if (reached_)
    solved_.reason = StopReason::reached_tolerance;
  else if (solved_.iterations >= budget_.max_iterations)
    solved_.reason = StopReason::iteration_limit;
  else if (seconds() >= budget_.max_seconds)
    solved_.reason = StopReason::time_limit;
  return std::move(solved_);
}

}  // namespace ballast
