#pragma once
// What a step leaves to the next one, besides the motion.

#include <vector>

#include "geometry/contact/contact_detector.hpp"

namespace ballast {

/// Warm start and contacts of the last step, and who sleeps: with the MotionState, all that the
/// next step depends on.
struct StepMemory {
  std::vector<ContactPoint>
      contacts;  ///< sorted by (body_a, body_b, feature); those of sleeping islands as they were
  std::vector<Vec3> impulses;  ///< on body b, world frame [N s]
  /// Per body, only where the scene lets islands sleep (else empty): steps for which it has been at
  /// rest, or `asleep`.
  std::vector<int> rest{};
  static constexpr int asleep = -1;
};

}  // namespace ballast
