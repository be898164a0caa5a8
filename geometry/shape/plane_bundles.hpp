#pragma once
// Many planes against many points at once. For mesh_checks.cpp.

#include <span>

#include "geometry/shape/pose.hpp"

namespace ballast {

/// The lowest f for which a point has normals[f].(p - points[on[f]]) > allowed[f] [m]; -1 where
/// none has. `on[f]`: a point of plane f; normals are of length 1. In a time that hardly grows
/// faster than the number of planes where they are those of a smooth or a flat-faced surface.
int first_plane_with_front(std::span<const Vec3> points, std::span<const int> on,
                           std::span<const Vec3> normals, std::span<const double> allowed);

}  // namespace ballast
