#pragma once
// Where the points of a set lie.

#include <span>

#include "geometry/shape/pose.hpp"

namespace ballast {

/// Of at least one point.
inline Vec3 mean(std::span<const Vec3> points) {
  Vec3 sum = Vec3::Zero();
  for (const Vec3& p : points) sum += p;
  return sum / static_cast<double>(points.size());
}

/// Corners of the smallest box along the axes that holds a set.
struct Bounds {
  Vec3 low, high;
  double largest_extent() const { return (high - low).maxCoeff(); }
};

/// Of at least one point.
inline Bounds bounds_of(std::span<const Vec3> points) {
  Bounds bounds{points[0], points[0]};
  for (const Vec3& p : points) {
    bounds.low = bounds.low.cwiseMin(p);
    bounds.high = bounds.high.cwiseMax(p);
  }
  return bounds;
}

}  // namespace ballast
