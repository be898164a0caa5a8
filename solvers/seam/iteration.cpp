#include "solvers/seam/iteration.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "platform/clock.hpp"
#include "solvers/seam/fclib_stop.hpp"

namespace ballast {

Iteration::Iteration(const Budget& budget, const CheckSchedule& schedule, int patience)
    : budget_(budget),
      schedule_(schedule),
      next_check_(schedule.first),
      patience_(patience),
      error_(std::numeric_limits<double>::quiet_NaN()) {}

double Iteration::seconds() const { return watch_.seconds() - startup_; }

bool Iteration::next() {
  if (stopped_) return false;
  ++count_;
  return true;
}

bool Iteration::error_due() {
  // Once the time is over the iterate must be judged, and it is the last.
  out_of_time_ = seconds() >= budget_.max_seconds;
  return count_ >= next_check_ || count_ >= budget_.max_iterations || out_of_time_;
}

void Iteration::evaluated(double error, const Impulses& r) {
  const bool is_enough = budget_.fclib && budget_.fclib->reached(r, error);
  const double now = seconds();
  // What is remembered: the point, and since when the error has not changed in any digit.
  if (budget_.keep_history) history_.push_back({count_, now, error});
  if (!(error == error_)) unchanged_since_ = count_;
  error_ = error;
  // The next look: later by the factor that fits the distance.
  const bool is_far = error > CheckSchedule::far * budget_.aim();
  const double growth = is_far ? schedule_.growth_far : schedule_.growth;
  while (next_check_ <= count_)
    next_check_ = std::max(next_check_ + 1, static_cast<int>(std::ceil(next_check_ * growth)));

  // Why to stop, the strongest reason first.
  stopped_ = true;
  if (!std::isfinite(error))
    reason_ = StopReason::numerical_failure;
  else if (is_enough || reached(error))
    reason_ = StopReason::reached_tolerance;
  else if (count_ >= budget_.max_iterations)
    reason_ = StopReason::iteration_limit;
  else if (out_of_time_ || now >= budget_.max_seconds)
    reason_ = StopReason::time_limit;
  else if (count_ - unchanged_since_ >= patience_ ||
           (budget_.leave && (*budget_.leave)(count_, error, r)))
    reason_ = StopReason::stalled;
  else
    stopped_ = false;
}

Solved Iteration::finish(Impulses impulses) {
  Solved solved;
  solved.impulses = std::move(impulses);
  solved.reason = reason_;
  solved.iterations = count_;
  solved.own_residual = error_;
  solved.startup_seconds = startup_;
  solved.history = std::move(history_);
  return solved;
}

}  // namespace ballast
