#include "tests/geometry/contact/detection_support.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "geometry/contact/axis_search.hpp"
#include "geometry/shape/convex_hull.hpp"
#include "geometry/shape/grain_shapes.hpp"

namespace ballast::testing {
namespace {

using LongVec = Eigen::Matrix<long double, 3, 1>;

std::vector<Polyhedron> make_pool() {
  std::vector<Polyhedron> pool;
  Random random(7);
  for (int i = 0; i < 4; ++i) {
    std::vector<Vec3> corners;
    for (int k = 0; k < 4; ++k)
      corners.push_back(random.uniform(0.02, 0.05) * random_direction(random));
    Vec3 mean = Vec3::Zero();
    for (const Vec3& p : corners) mean += 0.25 * p;
    for (Vec3& p : corners) p -= mean;
    pool.push_back(convex_hull(corners));
  }
  pool.push_back(make_box(Vec3(0.06, 0.06, 0.06)));
  pool.push_back(make_box(Vec3(0.04, 0.06, 0.09)));
  pool.push_back(make_box(Vec3(0.1, 0.1, 0.004)));
  pool.push_back(make_box(Vec3(0.005, 0.004, 0.1)));
  pool.push_back(make_box(Vec3(0.05, 0.06, 0.04)));
  for (int sides : {3, 5, 8}) pool.push_back(prism(sides, 0.03, 0.05));
  pool.push_back(make_sphere(0.04, 0));
  for (int i = 0; i < 10; ++i) {
    GrainShapeSettings settings;
    settings.max_vertices = i < 8 ? 14 : 37;
    pool.push_back(make_grain(settings, random.uniform(0.025, 0.05), 100 + i).shape);
  }
  pool.push_back(make_sphere(0.05, 1));
  return pool;
}

/// Points, stored as columns of x, y and z.
struct Cloud {
  using Column = Eigen::Array<double, Eigen::Dynamic, 1, Eigen::ColMajor, 64, 1>;
  template <class Map>
  Cloud(std::span<const Vec3> points, const Map& map)
      : x(points.size()), y(points.size()), z(points.size()) {
    for (size_t i = 0; i < points.size(); ++i) {
      const Vec3 p = map(points[i]);
      x[i] = p.x();
      y[i] = p.y();
      z[i] = p.z();
    }
  }
  /// Smallest and largest height along d.
  std::pair<double, double> extent(const Vec3& d) const {
    const Column heights = d.x() * x + d.y() * y + d.z() * z;
    return {heights.minCoeff(), heights.maxCoeff()};
  }
  double height(int i, const Vec3& d) const { return d.x() * x[i] + d.y() * y[i] + d.z() * z[i]; }
  Column x, y, z;
};

/// Computed in extended precision, for nearly parallel edges.
Vec3 unit_cross(const Vec3& u, const Vec3& v) {
  const LongVec n = u.cast<long double>().cross(v.cast<long double>());
  return (n / n.norm()).cast<double>();
}

RelativePose turned(const Quat& rotation, const Vec3& position) {
  return {rotation.toRotationMatrix(), position};
}

/// Moves b along the best axis until the separation is `gap`.
void set_gap(PairCase& c, double gap) {
  static AxisSearch search(collision_pool());
  for (int iteration = 0; iteration < 6; ++iteration) {
    AxisFeature hint;
    SeparatingAxis axis;
    search.find(c.pair(), 1e9, hint, axis);
    c.b_in_a.position += (gap - axis.separation) * axis.direction;
  }
}

PairCase faces_together(PairCase c, Random& random) {
  const Polyhedron &a = shape_pool()[c.a], &b = shape_pool()[c.b];
  const int f = random.below(a.face_count()), g = random.below(b.face_count());
  const Quat spin(
      Eigen::AngleAxisd(random.below(3) == 0 ? 0.0 : random.uniform(0.0, 6.28), a.normal(f)));
  const Quat rotation = spin * turned_onto(b.normal(g), -a.normal(f));
  Vec3 centre_a = Vec3::Zero(), centre_b = Vec3::Zero();
  for (int v : a.face(f)) centre_a += a.vertex(v) / static_cast<double>(a.face(f).size());
  for (int v : b.face(g)) centre_b += b.vertex(v) / static_cast<double>(b.face(g).size());
  Vec3 shift = random.below(3) == 0 ? Vec3(Vec3::Zero())
                                    : Vec3(random.uniform(0.0, 0.03) * random_direction(random));
  shift -= shift.dot(a.normal(f)) * a.normal(f);
  c.b_in_a = turned(
      rotation, centre_a - rotation * centre_b + shift + random_scale(random, 3, 12) * a.normal(f));
  return c;
}

}  // namespace

const std::vector<Polyhedron>& shape_pool() {
  static const std::vector<Polyhedron> pool = make_pool();
  return pool;
}

CollisionShape::FaceTable face_table(const CollisionShape& shape, int face) {
  CollisionShape::FaceTable table;
  shape.write(face, table);
  return table;
}

const std::vector<CollisionShape>& collision_pool() {
  static const std::vector<CollisionShape> pool(shape_pool().begin(), shape_pool().end());
  return pool;
}

Contact contact_of(const ShapePair& pair, double alert, int max_points) {
  const std::vector<CollisionShape> shapes{*pair.shape[0], *pair.shape[1]};
  AxisSearch search(shapes);
  ContactManifold manifold;
  Contact contact;
  AxisFeature hint;
  if (is_separated(search.find(pair, alert, hint, contact.axis))) return contact;
  contact.normal = contact_normal(pair, contact.axis);
  const auto points = manifold.points(pair, contact.axis, {alert, max_points});
  contact.points.assign(points.begin(), points.end());
  return contact;
}

Quat turned_onto(const Vec3& from, const Vec3& to) {
  const Vec3 a = from.normalized(), b = to.normalized(), axis = a.cross(b);
  if (a.dot(b) < -1.0 + 1e-9) return Quat(Eigen::AngleAxisd(std::numbers::pi, a.unitOrthogonal()));
  return Quat(1.0 + a.dot(b), axis.x(), axis.y(), axis.z()).normalized();
}

Polyhedron prism(int sides, double radius, double height) {
  std::vector<Vec3> vertices;
  std::vector<int> bottom, top;
  for (int k = 0; k < sides; ++k) {
    const double angle = 2.0 * 3.14159265358979323846 * k / sides;
    for (double z : {-0.5 * height, 0.5 * height})
      vertices.emplace_back(radius * std::cos(angle), radius * std::sin(angle), z);
    bottom.insert(bottom.begin(), 2 * k);
    top.push_back(2 * k + 1);
  }
  std::vector<std::vector<int>> faces{bottom, top};
  for (int k = 0; k < sides; ++k) {
    const int l = (k + 1) % sides;
    faces.push_back({2 * k, 2 * l, 2 * l + 1, 2 * k + 1});
  }
  return Polyhedron(vertices, faces);
}

BruteForce brute_force(const Polyhedron& a, const Polyhedron& b, const RelativePose& b_in_a) {
  const Cloud points_a(a.vertices(), [](const Vec3& p) { return p; });
  const Cloud points_b(b.vertices(), [&](const Vec3& p) { return b_in_a * p; });
  BruteForce best{-1e300, -1e300, Vec3::Zero(), false};
  const double exact = 1e-12 * (a.circumradius() + b.circumradius());
  const auto take = [&](const Vec3& n, double separation, bool facet) {
    if (facet) best.facets = std::max(best.facets, separation);
    if (separation <= best.all) return;
    best.all = separation;
    best.normal = n;
  };
  for (const Vec3& n : a.normals())
    take(n, points_b.extent(n).first - points_a.extent(n).second, true);
  for (const Vec3& n_b : b.normals()) {
    const Vec3 n = -(b_in_a.rotation * n_b);
    take(n, points_b.extent(n).first - points_a.extent(n).second, true);
  }
  for (const Polyhedron::Edge& ea : a.edges()) {
    const Vec3 along_a = a.vertex(ea.head) - a.vertex(ea.tail);
    for (const Polyhedron::Edge& eb : b.edges()) {
      const Vec3 along_b = b_in_a.rotation * (b.vertex(eb.head) - b.vertex(eb.tail));
      const double sine = along_a.cross(along_b).norm() / (along_a.norm() * along_b.norm());
      if (sine < parallel_sine) continue;
      if (sine < 1e-4) best.near_parallel = true;
      const Vec3 n =
          sine < 1e-4 ? unit_cross(along_a, along_b) : along_a.cross(along_b).normalized();
      const auto [low_a, high_a] = points_a.extent(n);
      const auto [low_b, high_b] = points_b.extent(n);
      const double a0 = points_a.height(ea.tail, n), a1 = points_a.height(ea.head, n);
      const double b0 = points_b.height(eb.tail, n), b1 = points_b.height(eb.head, n);
      take(n, low_b - high_a,
           std::min(a0, a1) >= high_a - exact && std::max(b0, b1) <= low_b + exact);
      take(-n, low_a - high_b,
           std::max(a0, a1) <= low_a + exact && std::min(b0, b1) >= high_b - exact);
    }
  }
  return best;
}

std::string name(Placement placement) {
  constexpr const char* names[] = {"near touching", "deep",   "parallel faces", "parallel edges",
                                   "offset copy",   "inside", "apart"};
  return names[static_cast<int>(placement)];
}

double random_scale(Random& random, double low, double high) {
  if (random.below(10) == 0) return 0.0;
  const double magnitude = std::pow(10.0, -random.uniform(low, high));
  return random.below(2) == 0 ? magnitude : -magnitude;
}

PairCase edges_together(double angle, Random& random) {
  const int count = static_cast<int>(shape_pool().size());
  PairCase c{random.below(count), random.below(count), turned(Quat::Identity(), Vec3::Zero())};
  const Polyhedron &a = shape_pool()[c.a], &b = shape_pool()[c.b];
  const Polyhedron::Edge ea = a.edges()[random.below(a.edge_count())];
  const Polyhedron::Edge eb = b.edges()[random.below(b.edge_count())];
  const Vec3 along_a = a.vertex(ea.head) - a.vertex(ea.tail),
             along_b = b.vertex(eb.head) - b.vertex(eb.tail);
  const Vec3 out_a = (a.normal(ea.left) + a.normal(ea.right)).normalized();
  const Vec3 out_b = (b.normal(eb.left) + b.normal(eb.right)).normalized();
  // Turns b's frame (edge, outward) onto a's, then by the angle about the outward direction.
  Mat3 frame_a, frame_b;
  frame_a << along_a.normalized(), out_a, along_a.normalized().cross(out_a);
  frame_b << along_b.normalized(), -out_b, along_b.normalized().cross(-out_b);
  const Mat3 turn = Eigen::AngleAxisd(angle, out_a).toRotationMatrix();
  const Mat3 rotation = turn * frame_a * frame_b.transpose();
  const Vec3 middle_a = 0.5 * (a.vertex(ea.head) + a.vertex(ea.tail));
  const Vec3 middle_b = 0.5 * (b.vertex(eb.head) + b.vertex(eb.tail));
  c.b_in_a = {rotation, middle_a - rotation * middle_b + random_scale(random, 3, 12) * out_a +
                            random.uniform(-0.3, 0.3) * along_a};
  return c;
}

PairCase random_case(Placement placement, Random& random) {
  const int count = static_cast<int>(shape_pool().size());
  PairCase c{random.below(count), random.below(count),
             turned(random_rotation(random), Vec3::Zero())};
  const double size = collision_pool()[c.a].circumradius() + collision_pool()[c.b].circumradius();
  switch (placement) {
    case Placement::near_touching:
      c.b_in_a.position = size * random_direction(random);
      set_gap(c, random_scale(random, 3, 12));
      return c;
    case Placement::deep:
      c.b_in_a.position = size * random.uniform(0.0, 0.5) * random_direction(random);
      return c;
    case Placement::parallel_faces:
      return faces_together(c, random);
    case Placement::parallel_edges:
      return edges_together(random_scale(random, 2, 6.5), random);
    case Placement::offset_copy: {
      c.b = c.a;
      const Vec3 turn = random_scale(random, 2, 14) * random_direction(random);
      c.b_in_a =
          turned(rotation_by(turn), size * random_scale(random, 2, 14) * random_direction(random));
      return c;
    }
    case Placement::inside:
      c.b_in_a.position = size * random_scale(random, 2, 8) * random_direction(random);
      return c;
    case Placement::apart:
      c.b_in_a.position = size * random.uniform(0.6, 3.0) * random_direction(random);
      return c;
  }
  return c;
}

}  // namespace ballast::testing
