#pragma once
// Points -> convex polyhedron: an adapter to qhull, which does the work.

#include <span>

#include "geometry/shape/polyhedron.hpp"

namespace ballast {

/// Hull of the points; coplanar facets (to 1e-10 of the size) are merged into polygons, interior
/// points are dropped, and so are points that rise less than 4e-9 half-extents or so over the hull
/// of the others. Vertices keep the order of the points; faces start at their smallest index and
/// come in ascending order. Throws InvalidPolyhedron on fewer than four points, NaN, or a flat set;
/// the message names the reason.
Polyhedron convex_hull(std::span<const Vec3> points);

/// Returns the solid that was meant by points that were rounded by about `rounding` of half their
/// extent, as single precision does: points that lie in one plane to that accuracy form one face
/// again, and its corners are moved to where the planes of their faces meet. No point is then
/// farther than ten roundings outside. If no such solid is found, returns the hull of the points as
/// they are. Throws as convex_hull.
Polyhedron rounded_hull(std::span<const Vec3> points, double rounding);

}  // namespace ballast
