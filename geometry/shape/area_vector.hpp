#pragma once
#include <cstddef>
#include <span>

#include "geometry/shape/pose.hpp"

namespace ballast {

/// Twice the area of a vertex loop times its unit normal [m^2], right-handed about the loop: a fan
/// of triangles about its first vertex (Newell's normal), so that loops far from the origin lose no
/// digits. The loop holds indices into `points` and need not be flat.
inline Vec3 area_vector(std::span<const int> loop, std::span<const Vec3> points) {
  const Vec3& first = points[loop[0]];
  Vec3 sum = Vec3::Zero();
  for (size_t k = 2; k < loop.size(); ++k)
    sum += (points[loop[k - 1]] - first).cross(points[loop[k]] - first);
  return sum;
}

}  // namespace ballast
