#include "geometry/shape/polyhedron.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <tuple>
#include <utility>

#include "geometry/shape/area_vector.hpp"
#include "geometry/shape/mesh_checks.hpp"
#include "geometry/shape/point_sets.hpp"
#include "geometry/shape/sorted_by_key.hpp"

namespace ballast {

namespace {

using mesh_checks::At;
using mesh_checks::invalid;

}  // namespace

Polyhedron::Polyhedron(std::vector<Vec3> vertices, const std::vector<std::vector<int>>& faces,
                       double tolerance, double rounding)
    : vertices_(std::move(vertices)) {
  mesh_checks::check_coordinates(vertices_);
  const Vec3 centre = mean(vertices_);
  for (const Vec3& p : vertices_) {
    size_ = std::max(size_, (p - centre).norm());
    circumradius_ = std::max(circumradius_, p.norm());
  }
  if (!(size_ > 0.0)) invalid(At{}, "all vertices coincide");
  if (!std::isfinite(size_ * size_ * size_))
    invalid(At{}, "coordinates are too large: the volume overflows");
  // Each check may rely on those before it: valid indices, distinct vertices, a closed surface in
  // one piece, flat faces, and only then that the whole is convex.
  mesh_checks::check_indices(vertex_count(), faces);
  mesh_checks::check_distinct(vertices_, tolerance * size_);
  build_faces(faces);
  join_faces();
  check_one_piece();
  const std::vector<double> thinness = build_planes(tolerance);
  check_convex(tolerance, rounding, thinness);
}

Polyhedron Polyhedron::with_vertices(std::vector<Vec3> vertices, double tolerance) const {
  std::vector<std::vector<int>> faces;
  for (int f = 0; f < face_count(); ++f) faces.emplace_back(face(f).begin(), face(f).end());
  return Polyhedron(std::move(vertices), faces, tolerance);
}

/// All loops in one array: face f has those from face_begin_[f] to before face_begin_[f + 1].
void Polyhedron::build_faces(const std::vector<std::vector<int>>& faces) {
  face_begin_.assign(1, 0);
  for (const std::vector<int>& face : faces) {
    face_vertices_.insert(face_vertices_.end(), face.begin(), face.end());
    face_begin_.push_back(static_cast<int>(face_vertices_.size()));
  }
  normals_.assign(faces.size(), Vec3::Zero());
  offsets_.assign(faces.size(), 0.0);
}

/// Each face runs along its edges once: a half-edge. The two half-edges between the same vertices
/// make an edge, and neighbours of their faces.
void Polyhedron::join_faces() {
  struct HalfEdge {
    int low, high;  // its ends
    bool downwards;
    int face, slot;  // slot: position in face_vertices_
  };
  std::vector<int> low_end, high_end, face_of;  // by slot
  for (int f = 0; f < face_count(); ++f) {
    for (int k = face_begin_[f]; k < face_begin_[f + 1]; ++k) {
      const int a = face_vertices_[k],
                b = face_vertices_[k + 1 < face_begin_[f + 1] ? k + 1 : face_begin_[f]];
      low_end.push_back(std::min(a, b));
      high_end.push_back(std::max(a, b));
      face_of.push_back(f);
    }
  }
  // By their smaller vertex in linear time; the few of one vertex are sorted.
  std::vector<HalfEdge> halves;
  const SortedByKey by_low = sorted_by_key(low_end, vertex_count());
  for (int low = 0; low < vertex_count(); ++low) {
    for (const int k : by_low.of(low))
      halves.push_back({low, high_end[k], face_vertices_[k] != low, face_of[k], k});
    std::sort(
        halves.begin() + by_low.begin[low], halves.end(), [](const HalfEdge& a, const HalfEdge& b) {
          return std::tie(a.high, a.downwards, a.slot) < std::tie(b.high, b.downwards, b.slot);
        });
  }
  // Sorted, the half-edges of one edge stand side by side, the upward one first.
  face_neighbours_.assign(face_vertices_.size(), -1);
  for (size_t i = 0; i < halves.size();) {
    size_t end = i;
    while (end < halves.size() && halves[end].low == halves[i].low &&
           halves[end].high == halves[i].high)
      ++end;
    const HalfEdge &up = halves[i], &down = halves[end - 1];
    if (end - i == 1)
      invalid(At{.face = up.face}, "the mesh is open at edge ", up.low, "-", up.high,
              ": only face ", up.face, " has it");
    if (end - i > 2) {
      int latest = 0;
      for (size_t k = i; k < end; ++k) latest = std::max(latest, halves[k].face);
      invalid(At{.face = latest}, "edge ", up.low, "-", up.high, " is shared by ", end - i,
              " faces (non-manifold), the last of them face ", latest);
    }
    if (up.downwards == down.downwards)
      invalid(At{.face = std::max(up.face, down.face)}, "faces ", up.face, " and ", down.face,
              " run along edge ", up.low, "-", up.high,
              " in the same direction: one of them is turned over");
    face_neighbours_[up.slot] = down.face;
    face_neighbours_[down.slot] = up.face;
    i = end;
  }
}

std::vector<Polyhedron::Edge> Polyhedron::edges() const {
  std::vector<Edge> edges;
  edges.reserve(face_vertices_.size() / 2);
  for (int f = 0; f < face_count(); ++f) {
    const std::span<const int> loop = face(f), across = face_neighbours(f);
    for (size_t k = 0; k < loop.size(); ++k) {
      const int to = loop[k + 1 < loop.size() ? k + 1 : 0];
      if (loop[k] < to) edges.push_back({loop[k], to, f, across[k]});
    }
  }
  std::sort(edges.begin(), edges.end(), [](const Edge& e, const Edge& g) {
    return std::tie(e.tail, e.head) < std::tie(g.tail, g.head);
  });
  return edges;
}

SortedByKey Polyhedron::faces_by_vertex() const {
  SortedByKey by_vertex = sorted_by_key(face_vertices_, vertex_count());
  std::vector<int> face_of(face_vertices_.size());
  for (int f = 0; f < face_count(); ++f)
    std::fill(face_of.begin() + face_begin_[f], face_of.begin() + face_begin_[f + 1], f);
  for (int& slot : by_vertex.order) slot = face_of[slot];
  return by_vertex;
}

/// Faces connected across edges and Euler's V - E + F = 2: together they leave only the sphere, as
/// handles and vertices where the surface touches itself both lower the sum.
void Polyhedron::check_one_piece() const {
  std::vector<int> reached{0};
  std::vector<bool> seen(normals_.size(), false);
  seen[0] = true;
  for (size_t i = 0; i < reached.size(); ++i) {
    for (const int g : face_neighbours(reached[i])) {
      if (!seen[g]) reached.push_back(g);
      seen[g] = true;
    }
  }
  if (static_cast<int>(reached.size()) != face_count()) {
    const auto missed = std::find(seen.begin(), seen.end(), false) - seen.begin();
    invalid(At{.face = static_cast<int>(missed)}, "the mesh has several pieces: face ", missed,
            " cannot be reached from face 0");
  }
  const int euler = vertex_count() - edge_count() + face_count();
  if (euler != 2) {
    invalid(At{}, "not a sphere: vertices - edges + faces = ", euler,
            " instead of 2 (a handle, or a vertex where the surface touches itself)");
  }
}

/// Returns for each face its extent over its double area: one over a height, large for thin faces.
std::vector<double> Polyhedron::build_planes(double tolerance) {
  std::vector<double> thinness;
  inradius_ = std::numeric_limits<double>::infinity();
  // 6 x signed volume, about a point inside so that far meshes lose no digits; 2 x surface
  double volume6 = 0.0, surface2 = 0.0;
  const Vec3 inside = mean(vertices_);
  for (int f = 0; f < face_count(); ++f) {
    const std::span<const int> loop = face(f);
    const Vec3 area2 = area_vector(loop, vertices_);
    const Vec3& first = vertices_[loop[0]];
    Vec3 centre = Vec3::Zero();
    for (const int v : loop) centre += vertices_[v] - first;
    centre = first + centre / static_cast<double>(loop.size());
    const double length = area2.norm();
    // A face has no area when its height over its longest extent vanishes, whatever its shape.
    double extent = 0.0;
    for (const int v : loop) extent = std::max(extent, (vertices_[v] - first).norm());
    if (!(length > tolerance * size_ * extent))
      invalid(At{.face = f}, "face ", f, " has no area (a needle or folded face)");
    // Through the mean of the corners; the offset is the plane's signed distance from the origin.
    normals_[f] = area2 / length;
    offsets_[f] = normals_[f].dot(centre);
    inradius_ = std::min(inradius_, offsets_[f]);
    // The pyramid from `inside` over the face has the volume area times height / 3: area2 is twice
    // the area, so that this product is six times that volume.
    volume6 += area2.dot(centre - inside);
    surface2 += length;
    thinness.push_back(extent / length);
    mesh_checks::check_loop(vertices_, f, loop, normals_[f], offsets_[f], size_, tolerance);
  }
  const double thickness =
      2.0 / 3.0 * volume6 / surface2;  // of a plate: volume over half the surface
  if (thickness < -tolerance * size_)
    invalid(At{}, "all faces are turned inward: the enclosed volume is negative");
  if (!(thickness > tolerance * size_)) invalid(At{}, "the mesh is flat: it encloses no volume");
  return thinness;
}

/// Thin faces know their plane badly: an error of one rounding over the height of the face tilts it
/// by that angle.
void Polyhedron::check_convex(double tolerance, double rounding,
                              const std::vector<double>& thinness) const {
  const double computed = 4.0 * std::numeric_limits<double>::epsilon() * (circumradius_ + size_);
  const double known = std::max(computed, rounding * size_);
  std::vector<double> blur;  // of each face's plane within the solid [m]
  for (int f = 0; f < face_count(); ++f) blur.push_back(known * (1.0 + 2.0 * size_ * thinness[f]));
  const bool has_triangles_only = face_vertices_.size() == 3 * normals_.size();
  if (has_triangles_only &&
      mesh_checks::is_surely_convex(vertices_, face_vertices_, face_neighbours_, normals_, blur))
    return;
  std::vector<int> first;
  std::vector<double> allowed;
  for (int f = 0; f < face_count(); ++f) {
    first.push_back(face(f)[0]);
    allowed.push_back(tolerance * size_ + blur[f]);
  }
  mesh_checks::check_convex(vertices_, first, normals_, allowed, size_);
}

Polyhedron make_box(const Vec3& size) {
  if (!(size.minCoeff() > 0.0))
    invalid(At{}, "a box needs positive side lengths, got ", size.transpose());
  std::vector<Vec3> corners;
  for (int i = 0; i < 8; ++i) {  // bit 0: +x, bit 1: +y, bit 2: +z
    corners.push_back(0.5 * Vec3(i & 1 ? size.x() : -size.x(), i & 2 ? size.y() : -size.y(),
                                 i & 4 ? size.z() : -size.z()));
  }
  // Seen from outside each counter-clockwise: -x, +x, -y, +y, -z, +z.
  return Polyhedron(
      std::move(corners),
      {{0, 4, 6, 2}, {1, 3, 7, 5}, {0, 1, 5, 4}, {2, 6, 7, 3}, {0, 2, 3, 1}, {4, 5, 7, 6}});
}

}  // namespace ballast
