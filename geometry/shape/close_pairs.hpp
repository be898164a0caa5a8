#pragma once
// Points of a set that lie close together: vertices that coincide, corners to be welded.

#include <span>
#include <utility>
#include <vector>

#include "geometry/shape/pose.hpp"

namespace ballast {

/// All pairs (i, j), i < j, of points at most `reach` apart. O(n log n) for sets with few such
/// pairs.
std::vector<std::pair<int, int>> close_pairs(std::span<const Vec3> points, double reach);

}  // namespace ballast
