#include "solvers/seam/solver.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "platform/text.hpp"

namespace ballast {

const char* name_of(StopReason reason) {
  return name_in(
      {"reached_tolerance", "iteration_limit", "time_limit", "stalled", "numerical_failure"},
      reason);
}

const char* name_of(Verdict verdict) { return name_in(verdict_names, verdict); }

const char* name_of(ContactLaw law) { return name_in({"coulomb", "convex_relaxation"}, law); }

bool FclibStop::reached(const Impulses& r, double natural_map) {
  if (!std::isfinite(natural_map)) return false;
  const bool is_idle = natural_map > 0.5 * looked_at_ && natural_map > near_aim * aim_;
  if (looks_ >= first_looks && is_idle) return false;
  ++looks_;
  looked_at_ = natural_map;
  const double value = judge_.fclib(*problem_, r, free_norm_);
  aim_ = value > 0.0 ? natural_map * tolerance_ / value : natural_map;
  return value <= tolerance_ * (1.0 - stop_margin);
}

Budget Budget::after(int iterations, double seconds) const {
  Budget rest = *this;
  rest.max_iterations = std::max(0, max_iterations - iterations);
  rest.max_seconds = std::max(0.0, max_seconds - seconds);
  return rest;
}

void Solved::go_on(Solved next, double seconds) {
  // Where the histories meet, the point of `next` replaces the last point of this one.
  if (!history.empty() && !next.history.empty() &&
      history.back().iteration == iterations + next.history.front().iteration)
    history.pop_back();
  for (const HistoryPoint& point : next.history)
    history.push_back({iterations + point.iteration, seconds + point.seconds, point.error});
  next.history = std::move(history);
  if (iterations > 0) next.start_error = start_error;
  next.iterations += iterations;
  next.startup_seconds += startup_seconds;
  *this = std::move(next);
}

}  // namespace ballast
