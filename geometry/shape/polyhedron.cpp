#include "geometry/shape/polyhedron.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <sstream>
#include <tuple>
#include <utility>

namespace ballast {

namespace {

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

/// Throws unless there are at least four vertices, with finite coordinates.
void check_coordinates(std::span<const Vec3> vertices) {
  for (size_t v = 0; v < vertices.size(); ++v)
    if (!vertices[v].allFinite())
      invalid(At{.vertex = static_cast<int>(v)}, "vertex ", v,
              " has a coordinate that is NaN or infinite");
  if (vertices.size() < 4)
    invalid(At{}, "a polyhedron needs at least 4 vertices, got ", vertices.size());
}

/// Throws unless faces have at least 3 vertices, all in range and different, and none is unused.
void check_indices(int vertex_count, const std::vector<std::vector<int>>& faces) {
  std::vector<int> last_face(vertex_count, -1);  // in which a vertex was found
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
    }
  }
  for (int v = 0; v < vertex_count; ++v)
    if (last_face[v] < 0) invalid(At{.vertex = v}, "vertex ", v, " belongs to no face");
}

/// A vertex may lie `tolerance` times the size of the whole mesh off the plane normal.x = offset.
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

}  // namespace

Polyhedron::Polyhedron(std::vector<Vec3> vertices, const std::vector<std::vector<int>>& faces,
                       double tolerance, double rounding)
    : vertices_(std::move(vertices)) {
  check_coordinates(vertices_);
  measure_size();
  if (!(size_ > 0.0)) invalid(At{}, "all vertices coincide");
  if (!std::isfinite(size_ * size_ * size_))
    invalid(At{}, "coordinates are too large: the volume overflows");
  // Each check may rely on those before it: valid indices, distinct vertices, a closed surface in
  // one piece, flat faces, and only then that the whole is convex.
  check_indices(vertex_count(), faces);
  const std::vector<int> first = first_close(vertices_, tolerance * size_);
  for (int v = 0; v < vertex_count(); ++v)
    if (first[v] != v) invalid(At{.vertex = v}, "vertices ", first[v], " and ", v, " coincide");
  build_faces(faces);
  join_faces();
  check_one_piece();
  const std::vector<double> thinness = build_planes(tolerance);
  check_convex(tolerance, rounding, thinness);
}

Polyhedron Polyhedron::with_vertices(std::vector<Vec3> vertices) const {
  std::vector<std::vector<int>> faces;
  for (int f = 0; f < face_count(); ++f) faces.emplace_back(face(f).begin(), face(f).end());
  return Polyhedron(std::move(vertices), faces);
}

Polyhedron Polyhedron::in_frame(const Mat3& axes, const Vec3& origin) const {
  Polyhedron moved = *this;
  for (Vec3& p : moved.vertices_) p = axes.transpose() * (p - origin);
  moved.measure_size();
  // Twice the constructor's tolerance: a motion adds its rounding to faces that were just flat
  // enough.
  moved.build_planes(2e-9);
  return moved;
}

void Polyhedron::measure_size() {
  const Vec3 centre = mean(vertices_);
  size_ = circumradius_ = 0.0;
  for (const Vec3& p : vertices_) {
    size_ = std::max(size_, (p - centre).norm());
    circumradius_ = std::max(circumradius_, p.norm());
  }
}

/// Puts all loops in one array: face f has face_begin_[f] to before face_begin_[f + 1].
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
/// make an edge, and make their faces neighbours.
void Polyhedron::join_faces() {
  struct HalfEdge {
    int low, high;  // its ends
    bool downwards;
    int face, slot;  // slot: position in face_vertices_
  };
  std::vector<HalfEdge> halves;
  for (int f = 0; f < face_count(); ++f)
    for (int k = face_begin_[f]; k < face_begin_[f + 1]; ++k) {
      const int a = face_vertices_[k],
                b = face_vertices_[k + 1 < face_begin_[f + 1] ? k + 1 : face_begin_[f]];
      halves.push_back({std::min(a, b), std::max(a, b), b < a, f, k});
    }
  std::ranges::sort(halves, {}, [](const HalfEdge& half) {
    return std::tuple(half.low, half.high, half.downwards, half.slot);
  });
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
  std::ranges::sort(edges, {}, [](const Edge& edge) { return std::pair(edge.tail, edge.head); });
  return edges;
}

std::vector<std::vector<int>> Polyhedron::faces_by_vertex() const {
  std::vector<std::vector<int>> faces(vertices_.size());
  for (int f = 0; f < face_count(); ++f)
    for (const int v : face(f)) faces[v].push_back(f);
  return faces;
}

/// Requires faces connected across edges and Euler's V - E + F = 2: together they leave only the
/// sphere, as handles and vertices where the surface touches itself both lower the sum.
void Polyhedron::check_one_piece() const {
  std::vector<int> reached{0};
  std::vector<bool> seen(normals_.size(), false);
  seen[0] = true;
  for (size_t i = 0; i < reached.size(); ++i)
    for (const int g : face_neighbours(reached[i])) {
      if (!seen[g]) reached.push_back(g);
      seen[g] = true;
    }
  if (static_cast<int>(reached.size()) != face_count()) {
    const auto missed = std::find(seen.begin(), seen.end(), false) - seen.begin();
    invalid(At{.face = static_cast<int>(missed)}, "the mesh has several pieces: face ", missed,
            " cannot be reached from face 0");
  }
  const int euler = vertex_count() - edge_count() + face_count();
  if (euler != 2)
    invalid(At{}, "not a sphere: vertices - edges + faces = ", euler,
            " instead of 2 (a handle, or a vertex where the surface touches itself)");
}

/// Returns each face's extent over twice its area: one over a height, large for thin faces.
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
    // The plane goes through the corners' mean; its offset is its signed distance from the origin.
    normals_[f] = area2 / length;
    offsets_[f] = normals_[f].dot(centre);
    inradius_ = std::min(inradius_, offsets_[f]);
    // The pyramid from `inside` over the face has the volume area times height / 3: area2 is twice
    // the area, so that this product is six times that volume.
    volume6 += area2.dot(centre - inside);
    surface2 += length;
    thinness.push_back(extent / length);
    check_loop(vertices_, f, loop, normals_[f], offsets_[f], size_, tolerance);
  }
  const double thickness = 2.0 / 3.0 * volume6 / surface2;  // volume over half the surface
  if (thickness < -tolerance * size_)
    invalid(At{}, "all faces are turned inward: the enclosed volume is negative");
  if (!(thickness > tolerance * size_)) invalid(At{}, "the mesh is flat: it encloses no volume");
  return thinness;
}

/// The plane of a thin face is known badly: an error of one rounding over the height of the face
/// tilts it by that angle.
void Polyhedron::check_convex(double tolerance, double rounding,
                              const std::vector<double>& thinness) const {
  const double computed = 4.0 * std::numeric_limits<double>::epsilon() * (circumradius_ + size_);
  const double known = std::max(computed, rounding * size_);
  // With distinct vertices, convex faces and one sphere this is enough: a surface that covered the
  // hull more than once would need each corner of the hull twice.
  for (int f = 0; f < face_count(); ++f) {
    // The second term says how well the face's plane is known within the solid.
    const double allowed = tolerance * size_ + known * (1.0 + 2.0 * size_ * thinness[f]);
    const Vec3& origin = vertices_[face(f)[0]];
    for (int v = 0; v < vertex_count(); ++v) {
      const double height = normals_[f].dot(vertices_[v] - origin);
      if (height > allowed)
        invalid(At{.face = f}, "not convex: vertex ", v, " lies ", height / size_,
                " of the size in front of face ", f);
    }
  }
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
