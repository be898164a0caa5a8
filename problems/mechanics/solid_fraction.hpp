#pragma once
// How much of a box at rest is filled with grains: Fig. 12 of the paper.

#include "geometry/shape/clipped_volume.hpp"
#include "problems/mechanics/mechanical_system.hpp"

namespace ballast {

/// The axis-aligned box [lo, hi], world frame [m]. Keeps buffers: one per thread.
class ControlVolume {
 public:
  /// Throws std::invalid_argument unless lo < hi in all three directions.
  ControlVolume(const Vec3& lo, const Vec3& hi);

  /// Volume of all grains inside the box over the volume of the box, exact to rounding. Overlaps of
  /// grains count twice.
  double solid_fraction(const MechanicalSystem& system, const MotionState& state);

  const Vec3& lo() const { return lo_; }
  const Vec3& hi() const { return hi_; }
  double volume() const { return (hi_ - lo_).prod(); }

 private:
  Vec3 lo_, hi_;
  BoxClipper clipper_;
};

}  // namespace ballast
