#pragma once
// How much of a box at rest is filled with grains: Fig. 12 of the paper.

#include <vector>

#include "geometry/shape/clipped_volume.hpp"
#include "platform/worker_team.hpp"
#include "problems/mechanics/mechanical_system.hpp"

namespace ballast {

/// The axis-aligned box [lo, hi], world frame [m]. Keeps buffers: one per calling thread.
class ControlVolume {
 public:
  /// Throws std::invalid_argument unless lo < hi in all three directions.
  ControlVolume(const Vec3& lo, const Vec3& hi);

  /// Volume of all grains inside the box over the volume of the box, exact to rounding. Overlaps of
  /// grains count twice. A team shares the work; its size changes no bit.
  double solid_fraction(const MechanicalSystem& system, const MotionState& state,
                        WorkerTeam* team = nullptr);

  const Vec3& lo() const { return lo_; }
  const Vec3& hi() const { return hi_; }
  double volume() const { return (hi_ - lo_).prod(); }

 private:
  Vec3 lo_, hi_;
  std::vector<BoxClipper> clippers_;  // one for each part of the work
  std::vector<double> inside_;        // of each grain [m^3]
};

}  // namespace ballast
