#pragma once
// The 5 Hz runs as Figs. 3 to 7 need them, and the states that they keep (record.state_rate),
// sorted by what the wall is doing: what one says of forces between bodies, and of the stress.

#include <functional>

#include "experiments/box/vibrated_box.hpp"
#include "experiments/paper/sections.hpp"
#include "experiments/record/checkpoint.hpp"
#include "problems/mechanics/mechanical_system.hpp"

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

/// All contact points of two bodies together: one contact of the field. Forces in newtons, world
/// frame.
struct PairForce {
  int body_a, body_b;
  Vec3 normal;    ///< unit, from a to b
  Vec3 position;  ///< of the points, weighted by their normal forces [m]
  Vec3 force;     ///< on b [N]
  double normal_force() const { return force.dot(normal); }  ///< > 0: compressive
};

/// Contacts must be sorted by (a, b), as detection gives them. Pairs without a compressive force
/// are left out. h: step of the impulses [s].
std::vector<PairForce> pair_forces(std::span<const ContactPoint> contacts,
                                   std::span<const Vec3> impulses, double h);

/// sigma = 1/V sum f l^T over contacts, f on b by a, l from a's centre to b's (from the contact
/// point where a is a wall); symmetric part. Compression is positive. volume [m^3]; [Pa].
Mat3 stress_tensor(const MechanicalSystem& system, const MotionState& state,
                   std::span<const PairForce> pairs, double volume);

/// Angle of the major principal direction within the xz plane to the horizontal, 0 to 90 degrees.
double major_inclination(const Mat3& tensor);

/// A point of one of the box's walls, where `state` has it [m].
Vec3 wall_place(const MechanicalSystem& system, const MotionState& state, BoxWall wall);
/// Volume between the box's walls [m^3]; `state` places them.
double box_volume(const MechanicalSystem& system, const MotionState& state);

/// Normal forces of grain-grain contacts over their mean.
std::vector<double> relative_normal_forces(const MechanicalSystem& system,
                                           std::span<const PairForce> pairs);

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
