#pragma once
// The adapter of qhull: coordinates in, faces of the hull out. For convex_hull.cpp.

#include <vector>

#include "geometry/shape/face_loops.hpp"

namespace ballast {

/// Faces of the convex hull of the points x0 y0 z0 x1 y1 z1 ... (left as they are, although qhull
/// wants them writable). Facets that are coplanar within a few `merge`, a length in the points'
/// unit, are one face. Order of the faces, orientation and first vertex of each are as qhull
/// leaves them. Throws InvalidPolyhedron where qhull gives up.
Loops qhull_loops(std::vector<double>& coordinates, double merge);

}  // namespace ballast
