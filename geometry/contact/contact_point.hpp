#pragma once
// A contact point, as detection reports it and everything after it reads it.

#include <cstdint>

#include "geometry/shape/pose.hpp"

namespace ballast {

/// One contact point between body a and body b. A plane is always a; of two polyhedra a has the
/// smaller index. contact_normal.hpp says how normal, position and gap are chosen.
struct ContactPoint {
  int body_a, body_b;
  std::uint64_t feature;  ///< key of the features that touch (feature_key.hpp): unique within the
                          ///< pair, the same from step to step while they do
  Vec3 normal;            ///< unit, world frame, from a to b; one normal for all points of a pair
  Vec3 position;          ///< world frame [m], midway between the two surfaces
  double gap;  ///< signed distance along the normal at this point [m]; negative = overlap
};

}  // namespace ballast
