#pragma once
// Wall clock: time that passes for the user, in seconds, never set back. And what this process has
// used: the processor's time, memory.

#include <sys/resource.h>

#include <chrono>
#include <ctime>

namespace ballast {

/// Runs from the moment it is made.
class Stopwatch {
 public:
  /// Since it was made or restarted [s].
  double seconds() const { return to_seconds(Clock::now() - begin_); }

  /// seconds() >= limit. Far from the limit a coarse clock says so, for a sixth of the price.
  bool has_passed(double limit) const {
    timespec now{};
    clock_gettime(CLOCK_MONOTONIC_COARSE, &now);
    const auto coarse = std::chrono::seconds(now.tv_sec) + std::chrono::nanoseconds(now.tv_nsec);
    if (to_seconds(coarse - begin_.time_since_epoch()) + coarse_tick < limit) return false;
    return seconds() >= limit;
  }

  /// The same, and begins again at zero: laps without a gap between them.
  double restart() {
    const Clock::time_point now = Clock::now();
    const double lap = to_seconds(now - begin_);
    begin_ = now;
    return lap;
  }

 private:
  using Clock = std::chrono::steady_clock;
  static double to_seconds(Clock::duration d) { return std::chrono::duration<double>(d).count(); }

  static constexpr double coarse_tick = 0.011;  ///< the coarse clock's delay is less [s]

  Clock::time_point begin_ = Clock::now();
};

/// Of this process, all its threads together, since it began [s]: what other programs on the
/// machine do not disturb. Waiting threads that spin count.
inline double processor_seconds() {
  timespec now{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

/// The most memory that this process has held so far [MB]; RUSAGE_CHILDREN: the largest process
/// that it waited for.
inline double peak_memory_MB(int who = RUSAGE_SELF) {
  rusage usage{};
  getrusage(who, &usage);
  return static_cast<double>(usage.ru_maxrss) / 1024.0;
}

}  // namespace ballast
