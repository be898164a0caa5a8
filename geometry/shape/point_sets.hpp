#pragma once
// Sets of points.

#include <cstddef>
#include <span>
#include <vector>

#include "geometry/shape/pose.hpp"

namespace ballast {

/// The mean of at least one point.
inline Vec3 mean(std::span<const Vec3> points) {
  Vec3 sum = Vec3::Zero();
  for (const Vec3& p : points) sum += p;
  return sum / static_cast<double>(points.size());
}

/// Corners of the smallest axis-aligned box that holds a set.
struct Bounds {
  Vec3 low, high;
  double largest_extent() const { return (high - low).maxCoeff(); }
};

/// The bounds of at least one point.
Bounds bounds_of(std::span<const Vec3> points);

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

/// For each point the smallest index of a point at most `reach` from it: its own where none before
/// it is that close. O(n log n) for sets with few points that are close or equal.
std::vector<int> first_close(std::span<const Vec3> points, double reach);

}  // namespace ballast
