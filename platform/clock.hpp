#pragma once
// The wall clock (in seconds, never set back), and the processor time and memory that this process
// has used.

#include <sys/resource.h>

#include <chrono>
#include <ctime>

namespace ballast {

/// Runs from the moment it is made.
class Stopwatch {
 public:
  /// Since it was made or restarted [s].
  double seconds() const { return to_seconds(Clock::now() - begin_); }

  /// Returns seconds() >= limit. Far from the limit a coarse clock decides, at a sixth of the cost.
  bool has_passed(double limit) const {
    timespec now{};
    clock_gettime(CLOCK_MONOTONIC_COARSE, &now);
    const auto coarse = std::chrono::seconds(now.tv_sec) + std::chrono::nanoseconds(now.tv_nsec);
    if (to_seconds(coarse - begin_.time_since_epoch()) + coarse_tick < limit) return false;
    return seconds() >= limit;
  }

  /// Returns seconds() and restarts at zero: successive laps have no gap between them.
  double restart() {
    const Clock::time_point now = Clock::now();
    const double lap = to_seconds(now - begin_);
    begin_ = now;
    return lap;
  }

 private:
  using Clock = std::chrono::steady_clock;
  static double to_seconds(Clock::duration d) { return std::chrono::duration<double>(d).count(); }

  static constexpr double coarse_tick = 0.011;  ///< the coarse clock lags by less [s]

  Clock::time_point begin_ = Clock::now();
};

/// Processor time of this process, all threads together, since it began [s]. Other programs on the
/// machine do not disturb it. Threads that spin while they wait count.
inline double processor_seconds() {
  timespec now{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

/// Peak memory of this process so far [MB]; with RUSAGE_CHILDREN, of the largest process that it
/// waited for.
inline double peak_memory_MB(int who = RUSAGE_SELF) {
  rusage usage{};
  getrusage(who, &usage);
  return static_cast<double>(usage.ru_maxrss) / 1024.0;
}

}  // namespace ballast
