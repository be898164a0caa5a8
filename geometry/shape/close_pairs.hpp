#pragma once
// Points of a set that lie close together: vertices that coincide, corners to be welded.

#include <span>
#include <vector>

#include "geometry/shape/pose.hpp"

namespace ballast {

/// For each point the smallest index of a point at most `reach` from it: its own where none before
/// it is that close. O(n log n), also where many points are equal, for sets with few that are close
/// without being equal.
std::vector<int> first_close(std::span<const Vec3> points, double reach);

}  // namespace ballast
