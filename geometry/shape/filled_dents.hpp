#pragma once
// A triangle mesh made convex by filling its dents.

#include <optional>

#include "geometry/shape/face_loops.hpp"
#include "geometry/shape/polyhedron.hpp"

namespace ballast {

/// Faces of the hull of a mesh of triangles that is nearly convex, as canonical loops of its
/// vertices. An edge that is bent inward is turned into the other diagonal of its two triangles,
/// and three triangles around a corner that lies within become one (Lawson 1977): each puts a
/// tetrahedron on the surface. The cost grows with the number of triangles and dents. Nothing where
/// the mesh has other faces or no such step is left before it is convex (Joe 1989): then only the
/// hull of the points helps. The loops are convex from edge to edge; whoever builds a solid of them
/// has the rest checked.
std::optional<Loops> filled_dents(const Polyhedron& mesh);

}  // namespace ballast
