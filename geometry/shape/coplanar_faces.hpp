#pragma once
// Neighbouring faces of a convex mesh that lie in one plane, and the polygons that they make.

#include <optional>
#include <vector>

#include "geometry/shape/face_loops.hpp"
#include "geometry/shape/polyhedron.hpp"

namespace ballast {

/// Neighbouring faces that lie in one plane.
struct FaceGroups {
  std::vector<int> of_face;  ///< each face's group, from 0 to before `count`
  int count = 0;
};

/// Neighbours that lie in one plane to `reach` [m]. Large faces begin groups, as the planes of
/// small ones are the least certain.
FaceGroups coplanar_groups(const Polyhedron& hull, double reach);

/// One loop of vertices, counter-clockwise seen from outside, for each group; vertices where only
/// two groups meet are left out. Nothing where a group is no disc, has fewer than three corners, or
/// a vertex that is left out lies more than `straight` [m] off the edge that is left.
std::optional<Loops> joined_faces(const Polyhedron& hull, const FaceGroups& groups,
                                  double straight);

}  // namespace ballast
