#pragma once
// Imposed motion of walls and bodies: given as a function of time, not computed.

#include <utility>
#include <vector>

#include "geometry/shape/pose.hpp"

namespace ballast {

/// rate t + amplitude (1 - cos 2 pi nu t) + the value of a table, linear between its rows, which
/// are sorted by time [s], and constant before the first and after the last. Zero at rest; without
/// a table also at t = 0. `Value`: double or Vec3.
template <class Value>
struct TimeFunction {
  Value rate, amplitude;
  double frequency = 0.0;  ///< nu [Hz]
  std::vector<std::pair<double, Value>> table = {};

  Value at(double t) const;
  /// The derivative; at a row of the table, that of the piece after the row.
  Value rate_at(double t) const;
};

/// A body is shifted, and turned about an axis that is shifted with it.
struct ImposedMotion {
  TimeFunction<Vec3> shift{Vec3::Zero(), Vec3::Zero()};  ///< [m], world frame
  Vec3 axis = Vec3::UnitZ();                             ///< unit, world frame
  Vec3 centre = Vec3::Zero();                            ///< a point of the axis at t = 0 [m]
  TimeFunction<double> turn{0.0, 0.0};                   ///< about the axis, right-handed [rad]

  /// The pose at t of a body that is at `start` when shift and turn are zero.
  Pose pose_at(double t, const Pose& start) const;
  /// The velocity of the body's point that is at `place` at t, world frame [m/s].
  Vec3 velocity_at(double t, const Vec3& place) const;
  /// Angular velocity, world frame [rad/s].
  Vec3 spin_at(double t) const { return turn.rate_at(t) * axis; }
};

}  // namespace ballast
