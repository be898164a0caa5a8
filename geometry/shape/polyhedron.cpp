#include "geometry/shape/polyhedron.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>
#include <sstream>
#include <tuple>
#include <utility>

namespace ballast {

namespace {

/// Where a defect lies: a face, a vertex, or neither.
struct At {
  int face = -1, vertex = -1;
};

template <class... Parts>
[[noreturn]] void invalid(At at, const Parts&... parts) {
  std::ostringstream message;
  (message << ... << parts);
  throw InvalidPolyhedron(message.str(), at.face, at.vertex);
}

Vec3 mean(std::span<const Vec3> points) {
  Vec3 sum = Vec3::Zero();
  for (const Vec3& p : points) sum += p;
  return sum / static_cast<double>(points.size());
}

/// Sorts each bucket of (bucket, value) pairs and lays them out one after another:
/// begin[b]..begin[b+1] of `values`.
void fill_buckets(std::vector<std::pair<int, int>> pairs, int buckets, std::vector<int>& begin,
                  std::vector<int>& values) {
  std::sort(pairs.begin(), pairs.end());
  begin.assign(buckets + 1, 0);
  values.clear();
  for (const auto& [bucket, value] : pairs) {
    ++begin[bucket + 1];
    values.push_back(value);
  }
  for (int b = 0; b < buckets; ++b) begin[b + 1] += begin[b];
}

}  // namespace

Polyhedron::Polyhedron(std::vector<Vec3> vertices, const std::vector<std::vector<int>>& faces,
                       double tolerance)
    : vertices_(std::move(vertices)) {
  for (int v = 0; v < vertex_count(); ++v) {
    if (!vertices_[v].allFinite())
      invalid(At{.vertex = v}, "vertex ", v, " has a coordinate that is NaN or infinite");
  }
  if (vertices_.size() < 4)
    invalid(At{}, "a polyhedron needs at least 4 vertices, got ", vertices_.size());
  const Vec3 centre = mean(vertices_);
  for (const Vec3& p : vertices_) {
    size_ = std::max(size_, (p - centre).norm());
    circumradius_ = std::max(circumradius_, p.norm());
  }
  if (!(size_ > 0.0)) invalid(At{}, "all vertices coincide");
  if (!std::isfinite(size_ * size_ * size_))
    invalid(At{}, "coordinates are too large: the volume overflows");
  check_input(faces, tolerance);
  build_faces(faces);
  build_edges();
  build_vertex_lists();
  check_one_piece();
  const std::vector<double> thinness = build_planes(tolerance);
  check_convex(tolerance, thinness);
}

/// Indices in range, no vertex twice in a face, none unused, none twice in space.
void Polyhedron::check_input(const std::vector<std::vector<int>>& faces, double tolerance) const {
  std::vector<bool> used(vertices_.size(), false);
  for (size_t f = 0; f < faces.size(); ++f) {
    if (faces[f].size() < 3)
      invalid(At{.face = static_cast<int>(f)}, "face ", f, " has ", faces[f].size(),
              " vertices: at least 3 are needed");
    std::set<int> seen;
    for (const int v : faces[f]) {
      if (v < 0 || v >= vertex_count())
        invalid(At{.face = static_cast<int>(f)}, "face ", f, " names vertex ", v, " of ",
                vertex_count());
      if (!seen.insert(v).second)
        invalid(At{.face = static_cast<int>(f)}, "face ", f, " passes through vertex ", v,
                " twice");
      used[v] = true;
    }
  }
  for (int v = 0; v < vertex_count(); ++v) {
    if (!used[v]) invalid(At{.vertex = v}, "vertex ", v, " belongs to no face");
  }
  // sweep along a direction in which no usual mesh has many equal heights: only close heights can
  // coincide
  const Vec3 direction = Vec3(0.5321, 0.6173, 0.5794).normalized();
  std::vector<std::pair<double, int>> order;
  for (int v = 0; v < vertex_count(); ++v)
    order.emplace_back(direction.dot(vertices_[v] - vertices_[0]), v);
  std::sort(order.begin(), order.end());
  const double reach = tolerance * size_;
  for (size_t i = 0; i < order.size(); ++i) {
    // twice the reach: the heights are rounded
    for (size_t j = i + 1; j < order.size() && order[j].first - order[i].first <= 2.0 * reach;
         ++j) {
      const int a = order[i].second, b = order[j].second;
      if ((vertices_[a] - vertices_[b]).norm() <= reach)
        invalid(At{.vertex = std::max(a, b)}, "vertices ", std::min(a, b), " and ", std::max(a, b),
                " coincide");
    }
  }
}

void Polyhedron::build_faces(const std::vector<std::vector<int>>& faces) {
  face_begin_.assign(1, 0);
  for (const std::vector<int>& face : faces) {
    face_vertices_.insert(face_vertices_.end(), face.begin(), face.end());
    face_begin_.push_back(static_cast<int>(face_vertices_.size()));
  }
  normals_.assign(faces.size(), Vec3::Zero());
  offsets_.assign(faces.size(), 0.0);
}

/// Pairs the half-edges; edges come out ordered by (smaller vertex, larger vertex), each running
/// upwards.
void Polyhedron::build_edges() {
  struct HalfEdge {
    int low, high;  // its ends
    bool downwards;
    int face, slot;  // slot: position in face_vertices_
  };
  std::vector<HalfEdge> halves;
  for (int f = 0; f < face_count(); ++f) {
    for (int k = face_begin_[f]; k < face_begin_[f + 1]; ++k) {
      const int a = face_vertices_[k],
                b = face_vertices_[k + 1 < face_begin_[f + 1] ? k + 1 : face_begin_[f]];
      halves.push_back({std::min(a, b), std::max(a, b), a > b, f, k});
    }
  }
  std::sort(halves.begin(), halves.end(), [](const HalfEdge& a, const HalfEdge& b) {
    return std::tie(a.low, a.high, a.downwards, a.slot) <
           std::tie(b.low, b.high, b.downwards, b.slot);
  });
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
    edges_.push_back({up.low, up.high, up.face, down.face});
    face_neighbours_[up.slot] = down.face;
    face_neighbours_[down.slot] = up.face;
    i = end;
  }
}

void Polyhedron::build_vertex_lists() {
  std::vector<std::pair<int, int>> pairs;
  for (const Edge& edge : edges_) {
    pairs.emplace_back(edge.tail, edge.head);
    pairs.emplace_back(edge.head, edge.tail);
  }
  fill_buckets(pairs, vertex_count(), neighbour_begin_, vertex_neighbours_);
  pairs.clear();
  for (int f = 0; f < face_count(); ++f) {
    for (const int v : face(f)) pairs.emplace_back(v, f);
  }
  fill_buckets(pairs, vertex_count(), vertex_face_begin_, vertex_faces_);
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
  double volume6 =
      0.0;  // 6 x signed volume, about a point inside so that far meshes lose no digits
  double surface2 = 0.0;  // 2 x surface
  const Vec3 inside = mean(vertices_);
  for (int f = 0; f < face_count(); ++f) {
    // Newell's normal: the area vector, twice; about the first vertex against cancellation
    Vec3 area2 = Vec3::Zero(), centre = Vec3::Zero();
    const std::span<const int> loop = face(f);
    const Vec3& first = vertices_[loop[0]];
    for (size_t k = 0; k < loop.size(); ++k) {
      if (k >= 2) area2 += (vertices_[loop[k - 1]] - first).cross(vertices_[loop[k]] - first);
      centre += vertices_[loop[k]] - first;
    }
    centre = first + centre / static_cast<double>(loop.size());
    const double length = area2.norm();
    // height over the longest extent: what makes the area zero, whatever the shape of the face
    double extent = 0.0;
    for (const int v : loop) extent = std::max(extent, (vertices_[v] - first).norm());
    if (!(length > tolerance * size_ * extent))
      invalid(At{.face = f}, "face ", f, " has no area (a needle or folded face)");
    normals_[f] = area2 / length;
    offsets_[f] = normals_[f].dot(centre);
    inradius_ = std::min(inradius_, offsets_[f]);
    volume6 += area2.dot(centre - inside);
    surface2 += length;
    thinness.push_back(extent / length);
    check_face(f, tolerance);
  }
  const double thickness =
      2.0 / 3.0 * volume6 / surface2;  // of a plate: volume over half the surface
  if (thickness < -tolerance * size_)
    invalid(At{}, "all faces are turned inward: the enclosed volume is negative");
  if (!(thickness > tolerance * size_)) invalid(At{}, "the mesh is flat: it encloses no volume");
  return thinness;
}

/// Flat, and strictly convex at each corner. Corners that all turn left by less than pi, once
/// around, make the loop a simple convex polygon.
void Polyhedron::check_face(int f, double tolerance) const {
  const std::span<const int> loop = face(f);
  const size_t n = loop.size();
  if (n == 3) return;
  for (const int v : loop) {
    const double height = normals_[f].dot(vertices_[v]) - offsets_[f];
    if (std::abs(height) > tolerance * size_)
      invalid(At{.face = f}, "face ", f, " is not flat: vertex ", v, " lies ",
              std::abs(height) / size_, " of the size off its plane");
  }
  double turning = 0.0;
  for (size_t k = 0; k < n; ++k) {
    const Vec3 in = vertices_[loop[k]] - vertices_[loop[(k + n - 1) % n]];
    const Vec3 out = vertices_[loop[(k + 1) % n]] - vertices_[loop[k]];
    const double sine = normals_[f].dot(in.cross(out)) / (in.norm() * out.norm());
    if (!(sine > 1e-12))
      invalid(At{.face = f}, "face ", f, " is not strictly convex at vertex ", loop[k],
              " (straight or re-entrant corner)");
    turning += std::atan2(sine, in.normalized().dot(out.normalized()));
  }
  constexpr double pi = 3.14159265358979323846;
  if (turning > 3.0 * pi) invalid(At{.face = f}, "face ", f, " winds around itself more than once");
}

/// Every vertex behind every face. With distinct vertices, convex faces and one sphere this is
/// enough: a surface that covered the hull more than once would need each corner of the hull twice.
void Polyhedron::check_convex(double tolerance, const std::vector<double>& thinness) const {
  const double rounding = 4.0 * std::numeric_limits<double>::epsilon() * (circumradius_ + size_);
  for (int f = 0; f < face_count(); ++f) {
    // Thin faces know their plane badly: an error of one rounding over the height of the face tilts
    // it by that angle.
    const double allowed = tolerance * size_ + rounding * (1.0 + 2.0 * size_ * thinness[f]);
    const Vec3& first = vertices_[face(f)[0]];
    for (int v = 0; v < vertex_count(); ++v) {
      const double height = normals_[f].dot(vertices_[v] - first);
      if (height > allowed)
        invalid(At{.face = f}, "not convex: vertex ", v, " lies ", height / size_,
                " of the size in front of face ", f);
    }
  }
}

int Polyhedron::support(const Vec3& d) const {
  int best = 0;
  double best_height = d.dot(vertices_[0]);
  for (int v = 1; v < vertex_count(); ++v) {
    const double height = d.dot(vertices_[v]);
    if (height > best_height) {
      best = v;
      best_height = height;
    }
  }
  return best;
}

Polyhedron make_box(const Vec3& size) {
  if (!(size.minCoeff() > 0.0))
    invalid(At{}, "a box needs positive side lengths, got ", size.transpose());
  std::vector<Vec3> corners;
  for (int i = 0; i < 8; ++i) {  // bit 0: +x, bit 1: +y, bit 2: +z
    corners.push_back(0.5 * Vec3(i & 1 ? size.x() : -size.x(), i & 2 ? size.y() : -size.y(),
                                 i & 4 ? size.z() : -size.z()));
  }
  return Polyhedron(
      std::move(corners),
      {{0, 4, 6, 2}, {1, 3, 7, 5}, {0, 1, 5, 4}, {2, 6, 7, 3}, {0, 2, 3, 1}, {4, 5, 7, 6}});
}

}  // namespace ballast
