#pragma once
// The 5 Hz runs as Figs. 3 to 7 need them, and the states that they keep (record.state_rate),
// sorted by what the wall is doing.

#include <functional>

#include "experiments/paper/grain_fields.hpp"
#include "experiments/paper/sections.hpp"

namespace ballast {

struct MotionRun {
  RunData data;
  RunSummary summary;
};

/// The finished runs of stage motion.
std::vector<MotionRun> read_motion(PaperData& data);

/// Mean over runs of a number of the summary, with its standard error.
template <class Function>
SampleMean mean_over(const std::vector<MotionRun>& runs, const Function& quantity) {
  std::vector<double> values;
  for (const MotionRun& run : runs) values.push_back(quantity(run.summary));
  return sample_mean(values);
}

/// One state of a run.
struct StoredState {
  const MechanicalSystem& system;
  Checkpoint at;
  double step = 0.0;  ///< h of the impulses [s]
  WallPhase phase = WallPhase::none;
  double wall_speed = 0.0;  ///< outward, smoothed [m/s]

  /// Forces between its bodies.
  std::vector<PairForce> pairs() const;
  /// Where it has a wall of the box [m].
  Vec3 wall(BoxWall which) const { return wall_place(system, at.state, which); }
  /// y of the plane halfway between the side walls [m].
  double middle() const { return 0.5 * (wall(wall_y_min).y() + wall(wall_y_max).y()); }
};

/// Calls `see` for every stored state after the transient, in the order of time; states whose wall
/// is slower than 20 % of its largest speed while it moves are left out: they are neither active
/// nor passive yet. Returns how many were seen. Throws Error.
int for_each_state(const MotionRun& run, const std::function<void(const StoredState&)>& see);

}  // namespace ballast
