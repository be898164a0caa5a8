#include "geometry/shape/mesh_checks.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "geometry/shape/close_pairs.hpp"
#include "geometry/shape/plane_bundles.hpp"

namespace ballast::mesh_checks {

void check_coordinates(std::span<const Vec3> vertices) {
  for (size_t v = 0; v < vertices.size(); ++v) {
    if (!vertices[v].allFinite())
      invalid(At{.vertex = static_cast<int>(v)}, "vertex ", v,
              " has a coordinate that is NaN or infinite");
  }
  if (vertices.size() < 4)
    invalid(At{}, "a polyhedron needs at least 4 vertices, got ", vertices.size());
}

void check_indices(int vertex_count, const std::vector<std::vector<int>>& faces) {
  std::vector<bool> used(vertex_count, false);
  std::vector<int> last_face(vertex_count, -1);  // that a vertex was found in
  for (size_t f = 0; f < faces.size(); ++f) {
    const At here{.face = static_cast<int>(f)};
    if (faces[f].size() < 3)
      invalid(here, "face ", f, " has ", faces[f].size(), " vertices: at least 3 are needed");
    for (const int v : faces[f]) {
      if (v < 0 || v >= vertex_count)
        invalid(here, "face ", f, " names vertex ", v, " of ", vertex_count);
      if (last_face[v] == static_cast<int>(f))
        invalid(here, "face ", f, " passes through vertex ", v, " twice");
      last_face[v] = static_cast<int>(f);
      used[v] = true;
    }
  }
  for (int v = 0; v < vertex_count; ++v) {
    if (!used[v]) invalid(At{.vertex = v}, "vertex ", v, " belongs to no face");
  }
}

void check_distinct(std::span<const Vec3> vertices, double reach) {
  const std::vector<int> first = first_close(vertices, reach);
  for (size_t v = 0; v < first.size(); ++v)
    if (first[v] != static_cast<int>(v))
      invalid(At{.vertex = static_cast<int>(v)}, "vertices ", first[v], " and ", v, " coincide");
}

/// Corners that all turn left by less than pi, once around, make the loop a simple convex polygon.
void check_loop(std::span<const Vec3> vertices, int face, std::span<const int> loop,
                const Vec3& normal, double offset, double size, double tolerance) {
  const size_t n = loop.size();
  if (n == 3) return;
  for (const int v : loop) {
    const double height = normal.dot(vertices[v]) - offset;
    if (std::abs(height) > tolerance * size)
      invalid(At{.face = face}, "face ", face, " is not flat: vertex ", v, " lies ",
              std::abs(height) / size, " of the size off its plane");
  }
  // Once around, the exterior angles of a simple polygon sum to 2 pi and those of one that winds
  // twice to 4 pi. Each is taken from the sine and cosine between the edges before and behind.
  double turning = 0.0;  // [rad]
  for (size_t k = 0; k < n; ++k) {
    const Vec3 in = vertices[loop[k]] - vertices[loop[(k + n - 1) % n]];
    const Vec3 out = vertices[loop[(k + 1) % n]] - vertices[loop[k]];
    const double sine = normal.dot(in.cross(out)) / (in.norm() * out.norm());
    if (!(sine > 1e-12))
      invalid(At{.face = face}, "face ", face, " is not strictly convex at vertex ", loop[k],
              " (straight or re-entrant corner)");
    turning += std::atan2(sine, in.normalized().dot(out.normalized()));
  }
  if (turning > 3.0 * std::numbers::pi)
    invalid(At{.face = face}, "face ", face, " winds around itself more than once");
}

/// With distinct vertices, convex faces and one sphere this is enough: a surface that covered the
/// hull more than once would need each corner of the hull twice.
void check_convex(std::span<const Vec3> vertices, std::span<const int> first,
                  std::span<const Vec3> normals, std::span<const double> allowed, double size) {
  const int face = first_plane_with_front(vertices, first, normals, allowed);
  if (face < 0) return;
  const auto f = static_cast<size_t>(face);
  const Vec3& origin = vertices[static_cast<size_t>(first[f])];
  // The first of them, for the message.
  for (size_t v = 0; v < vertices.size(); ++v) {
    const double height = normals[f].dot(vertices[v] - origin);
    if (height > allowed[f])
      invalid(At{.face = face}, "not convex: vertex ", v, " lies ", height / size,
              " of the size in front of face ", f);
  }
}

/// Seen from a point inside, in front of which no triangle is turned away, the surface covers the
/// sphere of directions a whole number of times: once where the solid angles sum to 4 pi. Then it
/// is no more than one layer, and one that is bent outward at every edge is convex (Tietze,
/// Nakajima). Edges alone do not tell: a double pyramid over a pentagram is bent outward at all of
/// them.
bool is_surely_convex(std::span<const Vec3> vertices, std::span<const int> corners,
                      std::span<const int> across, std::span<const Vec3> normals,
                      std::span<const double> blur) {
  Vec3 inside = Vec3::Zero();
  for (const Vec3& p : vertices) inside += p / static_cast<double>(vertices.size());
  const auto corner = [&](size_t f, size_t k) { return corners[3 * f + k % 3]; };
  double solid_angle = 0.0;
  for (size_t f = 0; f < normals.size(); ++f) {
    const Vec3& origin = vertices[static_cast<size_t>(corner(f, 0))];
    const auto height = [&](const Vec3& p) { return normals[f].dot(p - origin); };
    if (!(height(inside) < -blur[f])) return false;
    for (size_t k = 0; k < 3; ++k) {
      // The neighbour's third corner lies behind this plane.
      const size_t g = static_cast<size_t>(across[3 * f + k]);
      const int third =
          corner(g, 0) + corner(g, 1) + corner(g, 2) - corner(f, k) - corner(f, k + 1);
      if (!(height(vertices[static_cast<size_t>(third)]) < -blur[f])) return false;
    }
    // Van Oosterom and Strackee 1983.
    const Vec3 a = (origin - inside).normalized(),
               b = (vertices[static_cast<size_t>(corner(f, 1))] - inside).normalized(),
               c = (vertices[static_cast<size_t>(corner(f, 2))] - inside).normalized();
    solid_angle += 2.0 * std::atan2(a.dot(b.cross(c)), 1.0 + a.dot(b) + b.dot(c) + c.dot(a));
  }
  return solid_angle < 6.0 * std::numbers::pi;
}

}  // namespace ballast::mesh_checks
