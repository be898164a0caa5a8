#pragma once
// The states that the 5 Hz runs store (record.state_rate), for Figs. 6 and 7: the phase of the
// wall, the forces between bodies and the stress of each state.

#include "experiments/box/vibrated_box.hpp"
#include "experiments/paper/sections.hpp"
#include "experiments/record/checkpoint.hpp"
#include "problems/mechanics/mechanical_system.hpp"

namespace ballast {

/// All contact points of two bodies together, taken as one contact. Forces are in newtons, in the
/// world frame.
struct PairForce {
  int body_a, body_b;
  Vec3 normal;    ///< unit, from a to b
  Vec3 position;  ///< mean of the points, weighted by their normal forces [m]
  Vec3 force;     ///< on b [N]
  double normal_force() const { return force.dot(normal); }  ///< > 0: compressive
};

/// Angle of the major principal direction within the xz plane to the horizontal, 0 to 90 degrees.
double major_inclination(const Mat3& tensor);

/// One state of a run.
struct StoredState {
  const MechanicalSystem& system;
  Checkpoint at;
  double step = 0.0;  ///< the step h in which the impulses act [s]
  WallPhase phase = WallPhase::none;
  double wall_speed = 0.0;  ///< outward, smoothed [m/s]

  /// The forces between the bodies. The contacts must be sorted by (a, b), as detection gives them.
  /// Pairs without a compressive force are left out.
  std::vector<PairForce> pairs() const;
  /// The symmetric part of 1/V sum f l^T over contacts [Pa]; compression is positive. f is the
  /// force on b by a, l leads from a's centre to b's (from the contact point where a is a wall), V
  /// is the volume between the walls of the box.
  Mat3 stress() const;
  /// The centre of a grain; for a wall the position of the pair's contact [m].
  Vec3 centre(int body, const PairForce& pair) const;
  /// The position of a wall of the box [m].
  Vec3 wall(BoxWall which) const;
  /// The rectangle between the walls in x, from z = 0 to the lid.
  XzRectangle box() const {
    return {wall(wall_x_min).x(), wall(wall_x_max).x(), 0.0, wall(wall_lid).z()};
  }
  /// y of the plane halfway between the side walls [m].
  double middle() const { return 0.5 * (wall(wall_y_min).y() + wall(wall_y_max).y()); }
};

}  // namespace ballast
