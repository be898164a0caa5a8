#pragma once
// A mesh made convex by filling its dents.

#include <optional>

#include "geometry/shape/face_loops.hpp"
#include "geometry/shape/polyhedron.hpp"

namespace ballast {

/// Triangles of the hull of a mesh that is nearly convex, as canonical loops of its vertices. Faces
/// are cut into triangles; an edge that is bent inward is turned into the other diagonal of its two
/// triangles, and three triangles around a corner that lies within become one (Lawson 1977): each
/// puts a tetrahedron on the surface. The cost grows with the number of triangles and dents.
/// Nothing where no such step is left before it is convex (Joe 1989): then only the hull of the
/// points helps. The loops are convex from edge to edge. That they make one layer is checked by
/// whoever builds a solid of them, and that no vertex lies outside by whoever took a crumpled mesh.
std::optional<Loops> filled_dents(const Polyhedron& mesh);

}  // namespace ballast
