#pragma once

#include <vector>

#include "geometry/shape/pose.hpp"

namespace ballast {

/// One stored frame.
struct PoseFrame {
  double time = 0.0;
  long step = 0;
  std::vector<Pose> pose;
  std::vector<Vec3> velocity, spin;  ///< world frame, body frame
};

}  // namespace ballast
