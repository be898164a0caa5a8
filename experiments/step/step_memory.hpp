#pragma once
// What a step leaves to the next one, besides the motion.

#include <vector>

#include "geometry/contact/contact_detector.hpp"

namespace ballast {

/// Warm start and contacts of the last step: with the MotionState, all that the next step depends
/// on.
struct StepMemory {
  std::vector<ContactPoint> contacts;  ///< sorted by (body_a, body_b, feature)
  std::vector<Vec3> impulses;          ///< on body b, world frame [N s]
};

}  // namespace ballast
