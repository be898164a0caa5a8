#pragma once
// The convex solid that was meant by a mesh with dents no deeper than its numbers are exact.

#include "geometry/shape/polyhedron.hpp"

namespace ballast {

/// Meshes of so many vertices are mended as they stand. Smaller ones are soon made by qhull, which
/// has its own way with faces that are only just coplanar.
inline constexpr size_t many_vertices = 10000;

/// The convex hull of a mesh whose vertices lie at most `tolerance` times its largest extent within
/// it. Throws InvalidPolyhedron with the first vertex that lies deeper, or as convex_hull does.
Polyhedron hull_of_nearly_convex(const Polyhedron& mesh, double tolerance);

}  // namespace ballast
