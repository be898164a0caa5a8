#pragma once
// The states that the 5 Hz runs keep (record.state_rate), sorted by what the wall is doing.

#include <functional>

#include "experiments/paper/grain_fields.hpp"
#include "experiments/paper/motion.hpp"

namespace ballast {

/// One state of a run.
struct StoredState {
  const MechanicalSystem& system;
  Checkpoint at;
  double step = 0.0;  ///< h of the impulses [s]
  WallPhase phase = WallPhase::none;
  double wall_speed = 0.0;  ///< outward, smoothed [m/s]
};

/// Calls `see` for every stored state after the transient, in the order of time; states whose wall
/// is slower than 20 % of its largest speed while it moves are left out: they are neither active
/// nor passive yet. Returns how many were seen. Throws Error.
int for_each_state(const MotionRun& run, const std::function<void(const StoredState&)>& see);

}  // namespace ballast
