#pragma once
// Points -> convex polyhedron. qhull does the work; this is the adapter.

#include <span>

#include "geometry/shape/polyhedron.hpp"

namespace ballast {

/// Hull of the points; coplanar facets (to 1e-10 of the size) are merged into polygons, interior
/// points are dropped, and so are points that rise less than about 1e-8 of the size over the hull
/// of the others. Vertices keep the order of the points; faces start at their smallest index and
/// come in ascending order. Throws InvalidPolyhedron on fewer than four points, NaN, or a flat set;
/// the message names the reason.
Polyhedron convex_hull(std::span<const Vec3> points);

/// convex_hull of the vertices of a mesh that is convex already: its coplanar faces are joined, in
/// linear time; convex_hull itself is asked only where they make no sound solid. The same bits as
/// convex_hull where neighbours either lie in one plane to 1e-11 of the size or are bent by more
/// than 1e-8 of it. Throws as convex_hull.
Polyhedron convex_hull_of_mesh(const Polyhedron& mesh);

}  // namespace ballast
