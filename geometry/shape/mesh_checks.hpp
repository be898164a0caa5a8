#pragma once
// The checks that a list of faces must pass to be a convex polyhedron, one per kind of defect. Each
// throws InvalidPolyhedron with the first defect that it finds.

#include <span>
#include <sstream>
#include <vector>

#include "geometry/shape/invalid_polyhedron.hpp"
#include "geometry/shape/pose.hpp"

namespace ballast::mesh_checks {

/// Where a defect lies: a face, a vertex, or neither.
struct At {
  int face = -1, vertex = -1;
};

/// Throws InvalidPolyhedron; the message is the parts, one after the other.
template <class... Parts>
[[noreturn]] void invalid(At at, const Parts&... parts) {
  std::ostringstream message;
  (message << ... << parts);
  throw InvalidPolyhedron(message.str(), at.face, at.vertex);
}

/// At least four vertices, with finite coordinates.
void check_coordinates(std::span<const Vec3> vertices);

/// Faces of at least three vertices, indices in range, no vertex twice in a face, none unused.
void check_indices(int vertex_count, const std::vector<std::vector<int>>& faces);

/// No two vertices within `reach` [m] of each other.
void check_distinct(std::span<const Vec3> vertices, double reach);

/// A flat loop that is strictly convex at each corner. `size` [m]: of the whole mesh; a vertex may
/// lie `tolerance` times the size off the plane normal.x = offset.
void check_loop(std::span<const Vec3> vertices, int face, std::span<const int> loop,
                const Vec3& normal, double offset, double size, double tolerance);

/// Every vertex at most allowed[f] [m] in front of face f. `first[f]`: a vertex of that face.
void check_convex(std::span<const Vec3> vertices, std::span<const int> first,
                  std::span<const Vec3> normals, std::span<const double> allowed, double size);

/// True: these triangles, which make one closed surface, are convex, and no vertex lies in front of
/// any of their planes; told from neighbours alone, in linear time. False: not known, as where
/// neighbours lie nearly in one plane.
///
/// `corners`: three per triangle; across[3 f + k]: the triangle across corner k -> k + 1 of f;
/// blur[f]: how well f's plane is known within the solid [m].
bool is_surely_convex(std::span<const Vec3> vertices, std::span<const int> corners,
                      std::span<const int> across, std::span<const Vec3> normals,
                      std::span<const double> blur);

}  // namespace ballast::mesh_checks
