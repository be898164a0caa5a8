#pragma once
// Points -> convex polyhedron. qhull does the work; this is the adapter.

#include <span>

#include "geometry/polyhedron.hpp"

namespace ballast {

/// Hull of the points; coplanar facets (to 1e-9 of the size) are merged into polygons, interior points are dropped.
/// Throws InvalidPolyhedron on fewer than four points, NaN, or a flat set; the message names the reason.
Polyhedron convex_hull(std::span<const Vec3> points);

}  // namespace ballast
