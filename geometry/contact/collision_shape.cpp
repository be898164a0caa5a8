#include "geometry/contact/collision_shape.hpp"

#include <cmath>
#include <string>

#include "geometry/shape/point_sets.hpp"

namespace ballast {
namespace {

constexpr int lanes = 8;            // one AVX-512 register, two AVX, four SSE2
constexpr double far_away = 1e100;  // [m]; finite, so that sums of padding stay finite

int rounded_up(int count) { return (count + lanes - 1) / lanes * lanes; }

std::uint16_t to_uint16(int number) { return static_cast<std::uint16_t>(number); }
std::vector<std::uint16_t> to_uint16(const std::vector<int>& numbers) {
  return {numbers.begin(), numbers.end()};
}

/// The largest single-precision number that is not above `value`.
float rounded_down(double value) {
  const float nearest = static_cast<float>(value);
  return nearest > value ? std::nextafter(nearest, -HUGE_VALF) : nearest;
}

}  // namespace

AffineRows::AffineRows(int count, double padding) : count_(count), padded_(rounded_up(count)) {
  // Four columns of padded length, so that d.xyz + w is one pass of vector
  // instructions over all rows. The w of the padding is so far off that padding never
  // is the least height or the largest bound.
  //
  //     x x x x .. | y y y y .. | z z z z .. | w w w w .. P P
  table_.assign(4 * static_cast<size_t>(padded_), 0.0);
  std::fill(table_.end() - padded_, table_.end(), padding);
}

void AffineRows::set(int row, const Vec3& xyz, double w) {
  for (int axis = 0; axis < 3; ++axis)
    table_[axis * static_cast<size_t>(padded_) + row] = xyz[axis];
  table_[3 * static_cast<size_t>(padded_) + row] = w;
}

void AffineRows::evaluate(const Vec3& d, double* __restrict values) const {
  const double dx = d.x(), dy = d.y(), dz = d.z();
  const double* __restrict x = table_.data();
  const double* __restrict y = x + padded_;
  const double* __restrict z = y + padded_;
  const double* __restrict w = z + padded_;
  for (int i = 0; i < padded_; ++i) values[i] = ((dx * x[i] + dy * y[i]) + dz * z[i]) + w[i];
}

CollisionShape::CollisionShape(const Polyhedron& polyhedron) {
  if (2 * polyhedron.edge_count() > UINT16_MAX)
    throw InvalidPolyhedron("contact detection takes faces of 65535 corners together, not of " +
                            std::to_string(2 * polyhedron.edge_count()));
  bounds_.circumradius = polyhedron.circumradius();
  vertices_ = AffineRows(polyhedron.vertex_count(), far_away);
  for (int v = 0; v < polyhedron.vertex_count(); ++v) vertices_.set(v, polyhedron.vertex(v), 0.0);
  const std::vector<int> corners = build_faces(polyhedron);
  build_edges(polyhedron, corners);
  build_vertex_faces(polyhedron);
  build_ball(polyhedron);
}

void CollisionShape::write(int f, FaceTable& table) const {
  table.face = face(f);
  table.corners.clear();
  table.sides.clear();
  for (int k = 0; k < corner_count(f); ++k) {
    table.corners.push_back(corner(f, k));
    table.sides.push_back(side(f, k));
  }
}

/// Writes the faces and the isolation of each face's normal. Returns the corners' vertices, face by
/// face.
std::vector<int> CollisionShape::build_faces(const Polyhedron& polyhedron) {
  faces_ = AffineRows(polyhedron.face_count(), -far_away);
  std::vector<int> first_corner, corners;
  for (int f = 0; f < polyhedron.face_count(); ++f) {
    const Vec3& normal = polyhedron.normal(f);
    // The plane goes through the highest vertex and not the mean of the corners: no vertex is in
    // front of its face.
    double offset = -far_away;
    for (const Vec3& vertex : polyhedron.vertices())
      offset = std::max(offset, vertex_height(normal, vertex));
    faces_.set(f, normal, -offset);
    first_corner.push_back(static_cast<int>(corners.size()));
    for (const int v : polyhedron.face(f)) {
      corners.push_back(v);
      bounds_.planarity_error =
          std::max(bounds_.planarity_error, offset - vertex_height(normal, polyhedron.vertex(v)));
    }
  }
  first_corner.push_back(static_cast<int>(corners.size()));
  first_corner_ = to_uint16(first_corner);
  measure_isolation();
  return corners;
}

/// Writes the sine of the smallest angle to another face's normal, or one beyond 60 degrees.
void CollisionShape::measure_isolation() {
  std::vector<double> sines(faces_.count(), 1.0);
  for (int f = 0; f < faces_.count(); ++f) {
    const Vec3 own = faces_.xyz(f);
    for (int g = f + 1; g < faces_.count(); ++g) {
      const Vec3 other = faces_.xyz(g);
      if (own.dot(other) < 0.5) continue;
      const double sine = own.cross(other).norm();  // <= angle
      sines[f] = std::min(sines[f], sine);
      sines[g] = std::min(sines[g], sine);
    }
  }
  isolation_.reserve(sines.size());
  for (const double sine : sines) isolation_.push_back(rounded_down(sine));
}

/// Writes the edges and their places in the loops of the two faces beside each.
void CollisionShape::build_edges(const Polyhedron& polyhedron, std::span<const int> corners) {
  std::vector<int> edges, corner_edge(corners.size());
  drop_.reserve(corner_edge.size() / 2);
  const auto enter = [&](int f, int from) {
    int corner = first_corner_[f];
    while (corners[corner] != from) ++corner;
    corner_edge[corner] = edge_count();
  };
  for (const Polyhedron::Edge& edge : polyhedron.edges()) {
    const EdgeEnds ends{to_uint16(edge.tail), to_uint16(edge.head), to_uint16(edge.left),
                        to_uint16(edge.right)};
    enter(ends.left, ends.tail);
    enter(ends.right, ends.head);
    edges.insert(edges.end(), {ends.tail, ends.head, ends.left, ends.right});
    drop_.push_back(rounded_down(drop_below(ends, polyhedron)));
  }
  edges_ = to_uint16(edges);
  corner_edge_ = to_uint16(corner_edge);
}

/// Edge::drop: the common normal with an edge u is n = p left_normal + q right_normal with p, q
/// = |right_normal.u|, |left_normal.u| times length / (sine |along x u|), so that the least sum
/// of a vertex's depths below both faces bounds its depth along n.
double CollisionShape::drop_below(const EdgeEnds& edge, const Polyhedron& polyhedron) const {
  const Face left = face(edge.left), right = face(edge.right);
  double below = far_away;
  for (int v = 0; v < polyhedron.vertex_count(); ++v)
    if (v != edge.tail && v != edge.head)
      below = std::min(below, left.offset - left.normal.dot(polyhedron.vertex(v)) + right.offset -
                                  right.normal.dot(polyhedron.vertex(v)));
  const double length = (polyhedron.vertex(edge.head) - polyhedron.vertex(edge.tail)).norm();
  const double sine = left.normal.cross(right.normal).norm();
  constexpr double coplanar = 1e-9;  // rounding of the normals would be most of the bound
  return sine < coplanar ? 0.0 : below * length / sine;
}

void CollisionShape::build_vertex_faces(const Polyhedron& polyhedron) {
  std::vector<int> begins{0}, all;
  for (const std::vector<int>& faces : polyhedron.faces_by_vertex()) {
    all.insert(all.end(), faces.begin(), faces.end());
    std::sort(all.begin() + begins.back(), all.end());
    begins.push_back(static_cast<int>(all.size()));
  }
  vertex_begin_ = to_uint16(begins);
  vertex_faces_ = to_uint16(all);
}

/// Puts the ball around the origin (a grain's centre of mass) or the vertices' mean, whichever ball
/// is larger: the mean is always strictly inside, the origin of a user's frame need not be.
void CollisionShape::build_ball(const Polyhedron& polyhedron) {
  const Vec3 middle = mean(polyhedron.vertices());
  const auto radius_about = [&](const Vec3& centre) {
    double nearest = far_away;
    for (int f = 0; f < faces_.count(); ++f)
      nearest = std::min(nearest, face(f).offset - face(f).normal.dot(centre));
    return nearest;
  };
  if (radius_about(middle) > radius_about(Vec3::Zero())) bounds_.ball_centre = middle;
  bounds_.ball_radius = radius_about(bounds_.ball_centre);
}

}  // namespace ballast
