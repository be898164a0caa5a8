// The contact rule against its table of cases and against slow twins: the separation along every
// face normal and every cross product of edges, and the distance over all pairs of features.

#include "geometry/contact/contact_normal.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "tests/catch.hpp"
#include "tests/geometry/contact/detection_support.hpp"
#include "tests/geometry/shape/support_vertex.hpp"

using namespace ballast;
using namespace ballast::testing;

namespace {

/// Two points, one on each body, in a's frame.
struct Closest {
  double distance = 1e300;
  Vec3 on_a, on_b;
  void take(const Vec3& p, const Vec3& q) {
    if ((q - p).norm() >= distance) return;
    distance = (q - p).norm();
    on_a = p;
    on_b = q;
  }
};

/// The closest points of two segments p + s u and q + t v, 0 <= s, t <= 1 (Ericson, Real-time
/// collision detection, 5.1.9).
void take_segments(const Vec3& p, const Vec3& u, const Vec3& q, const Vec3& v, Closest& closest) {
  const Vec3 r = p - q;
  const double a = u.dot(u), e = v.dot(v), b = u.dot(v), c = u.dot(r), f = v.dot(r);
  const double denominator = a * e - b * b;
  double s =
      denominator > 1e-12 * a * e ? std::clamp((b * f - c * e) / denominator, 0.0, 1.0) : 0.0;
  const double t = std::clamp((b * s + f) / e, 0.0, 1.0);
  s = std::clamp((b * t - c) / a, 0.0, 1.0);
  closest.take(p + s * u, q + t * v);
}

/// The foot of the perpendicular from a point on a face, if it lies within the face.
std::optional<Vec3> foot_on_face(const Polyhedron& body, int f, const Vec3& point) {
  const Vec3& n = body.normal(f);
  const Vec3 foot = point - (n.dot(point) - body.offset(f)) * n;
  const auto loop = body.face(f);
  for (size_t k = 0; k < loop.size(); ++k) {
    const Vec3 &from = body.vertex(loop[k]), &to = body.vertex(loop[(k + 1) % loop.size()]);
    if (n.dot((to - from).cross(foot - from)) < 0.0) return std::nullopt;
  }
  return foot;
}

/// The distance of two separated polyhedra, by all vertices over all faces and all pairs of edges.
Closest closest_points(const Polyhedron& a, const Polyhedron& b, const RelativePose& b_in_a) {
  Closest closest;
  const RelativePose a_in_b = b_in_a.inverse();
  for (int f = 0; f < a.face_count(); ++f)
    for (const Vec3& vertex : b.vertices())
      if (const auto foot = foot_on_face(a, f, b_in_a * vertex))
        closest.take(*foot, b_in_a * vertex);
  for (int f = 0; f < b.face_count(); ++f)
    for (const Vec3& vertex : a.vertices())
      if (const auto foot = foot_on_face(b, f, a_in_b * vertex))
        closest.take(vertex, b_in_a * *foot);
  for (const Polyhedron::Edge& ea : a.edges())
    for (const Polyhedron::Edge& eb : b.edges())
      take_segments(a.vertex(ea.tail), a.vertex(ea.head) - a.vertex(ea.tail),
                    b_in_a * b.vertex(eb.tail),
                    b_in_a.rotation * (b.vertex(eb.head) - b.vertex(eb.tail)), closest);
  return closest;
}

Mat3 turn(double degrees, const Vec3& axis) {
  return Eigen::AngleAxisd(degrees * std::numbers::pi / 180.0, axis).toRotationMatrix();
}

const CollisionShape& unit_box() {
  static const CollisionShape box(make_box(Vec3(2, 2, 2)));
  return box;
}

/// Checks a case: every point has this gap and this height z, and the points have these x, y.
void check_case(const Contact& contact, double gap, double z,
                std::vector<std::pair<double, double>> places) {
  CHECK(contact.normal.isApprox(Vec3::UnitZ(), 1e-12));
  REQUIRE(contact.points.size() == places.size());
  for (const ManifoldPoint& p : contact.points) {
    CHECK(p.gap == Approx(gap).epsilon(1e-10));
    CHECK(p.position.z() == Approx(z).epsilon(1e-10));
    const auto at = std::find_if(places.begin(), places.end(), [&](const auto& place) {
      return (p.position.head<2>() - Eigen::Vector2d(place.first, place.second)).norm() < 1e-10;
    });
    REQUIRE(at != places.end());
    places.erase(at);
  }
}

}  // namespace

TEST_CASE("case table: face on face, edge on face, vertex on face") {
  const double depth = 1e-3, s2 = std::sqrt(2.0), s3 = std::sqrt(3.0);
  const auto above = [&](const Mat3& rotation, double height) {
    const ShapePair pair(unit_box(), unit_box(), {rotation, Vec3(0.5, 0.25, height - depth)});
    return contact_of(pair, 1e-4);
  };
  // A box on a box: the points are the corners of the common part.
  check_case(above(Mat3::Identity(), 2.0), -depth, 1.0 - 0.5 * depth,
             {{-0.5, -0.75}, {1.0, -0.75}, {1.0, 1.0}, {-0.5, 1.0}});
  // A box on its edge, along y: the points are both ends of the edge on the face.
  check_case(above(turn(45, Vec3::UnitY()), 1.0 + s2), -depth, 1.0 - 0.5 * depth,
             {{0.5, -0.75}, {0.5, 1.0}});
  // A box on its corner.
  const Mat3 on_corner = turned_onto(Vec3(1, 1, 1), Vec3(0, 0, -1)).toRotationMatrix();
  const Contact vertex = above(on_corner, 1.0 + s3);
  check_case(vertex, -depth, 1.0 - 0.5 * depth, {{0.5, 0.25}});
  CHECK(vertex.axis.feature.kind == AxisKind::face_of_a);
}

TEST_CASE(
    "case table: seen from the other body, a face of b decides and the normal still leaves a") {
  const double depth = 1e-3;
  const Mat3 on_corner = turned_onto(Vec3(1, 1, 1), Vec3(0, 0, 1)).toRotationMatrix();
  // Body a stands on its corner below b: its frame is turned.
  const RelativePose b_in_a{on_corner.transpose(),
                            on_corner.transpose() * Vec3(0, 0, 1.0 + std::sqrt(3.0) - depth)};
  const Contact contact = contact_of(ShapePair(unit_box(), unit_box(), b_in_a), 1e-4);
  CHECK(contact.axis.feature.kind == AxisKind::face_of_b);
  CHECK((on_corner * contact.normal).isApprox(Vec3::UnitZ(), 1e-12));
  REQUIRE(contact.points.size() == 1);
  CHECK(contact.points[0].gap == Approx(-depth).epsilon(1e-10));
  const Vec3 tip(0, 0, std::sqrt(3.0) - 0.5 * depth);
  CHECK((on_corner * contact.points[0].position - tip).norm() < 1e-12);
}

TEST_CASE("case table: edges that cross, parallel edges") {
  const double depth = 1e-3, s2 = std::sqrt(2.0);
  const CollisionShape rod(make_box(Vec3(10, 2, 2)));
  const Mat3 on_edge = turn(45, Vec3::UnitX());
  const auto upright = [&](const Mat3& rotation, const Vec3& shift) {
    const ShapePair pair(rod, rod, {on_edge.transpose() * rotation, on_edge.transpose() * shift});
    Contact contact = contact_of(pair, 1e-4);
    contact.normal = on_edge * contact.normal;
    for (ManifoldPoint& p : contact.points) p.position = on_edge * p.position;
    return contact;
  };
  // The lower rod's edge runs along x through y = 0, the upper one's along y through x = 0.7.
  const Contact crossing =
      upright(turn(90, Vec3::UnitZ()) * on_edge, Vec3(0.7, 0.4, 2.0 * s2 - depth));
  CHECK(crossing.axis.feature.kind == AxisKind::edges);
  check_case(crossing, -depth, s2 - 0.5 * depth, {{0.7, 0.0}});
  // Both edges along x, one above the other: the cross product is zero, a face separates as well.
  const Contact parallel = upright(on_edge, Vec3(1.0, 0.0, 2.0 * s2 - depth));
  CHECK(parallel.axis.feature.kind != AxisKind::edges);
  CHECK(parallel.points.size() >= 2);
  for (const ManifoldPoint& p : parallel.points) CHECK(p.gap < 0.0);
}

TEST_CASE("case table: flat edges touch at their crossing and at the common part's corners") {
  // a's top rises towards +y, b's bottom sinks towards +x, both by an angle t. The border of a
  // along x and that of b along y cross; the gap grows by tan t per metre away from either.
  const double t = 1e-3, depth = 1e-4, border = std::cos(t) - std::sin(t);
  const Mat3 tilt_a = Eigen::AngleAxisd(t, Vec3::UnitX()).toRotationMatrix();
  const Mat3 tilt_b = Eigen::AngleAxisd(t, Vec3::UnitY()).toRotationMatrix();
  const Vec3 centre(-0.5, 0.5, 2.0 * (std::cos(t) + std::sin(t)) - depth);
  const ShapePair pair(unit_box(), unit_box(),
                       {tilt_a.transpose() * tilt_b, tilt_a.transpose() * centre});
  const Contact contact = contact_of(pair, 0.1);
  CHECK(contact.axis.feature.kind == AxisKind::edges);
  CHECK((tilt_a * contact.normal).isApprox(Vec3::UnitZ(), 1e-12));
  REQUIRE(contact.points.size() == 4);
  for (const double x : {-1.0, centre.x() + border}) {
    for (const double y : {centre.y() - 1.0, border}) {
      const double gap = std::tan(t) * ((centre.x() + border - x) + (border - y)) - depth;
      CHECK(std::any_of(contact.points.begin(), contact.points.end(), [&](const ManifoldPoint& p) {
        const Vec3 at = tilt_a * p.position;
        return std::abs(p.gap - gap) < 1e-12 && std::hypot(at.x() - x, at.y() - y) < 1e-9;
      }));
    }
  }
  // Only the crossing is within a shorter reach.
  CHECK(contact_of(pair, 1e-4).points.size() == 1);
}

TEST_CASE(
    "the normal is the direction of least overlap, and the deepest gap the overlap along it") {
  Random random(72);
  int overlapping = 0, edges = 0;
  for (int i = 0; i < 6000; ++i) {
    const PairCase c = random_case(i % 2 ? Placement::deep : Placement::near_touching, random);
    const Contact contact = contact_of(c.pair(), 0.0);
    if (contact.points.empty()) continue;
    const Polyhedron &a = shape_pool()[c.a], &b = shape_pool()[c.b];
    const double small = 1e-12 * c.size();
    const Vec3& n = contact.normal;
    const Vec3 low = c.b_in_a * support_vertex(b, -(c.b_in_a.rotation.transpose() * n));
    const double along_normal = n.dot(low - support_vertex(a, n));
    double deepest = 1e300;
    for (const ManifoldPoint& p : contact.points) deepest = std::min(deepest, p.gap);
    ++overlapping;
    edges += contact.axis.feature.kind == AxisKind::edges;
    const BruteForce oracle = brute_force(a, b, c.b_in_a);
    if (std::abs(along_normal - oracle.all) > (oracle.near_parallel ? 1e3 : 1.0) * small ||
        std::abs(deepest - along_normal) > small)
      FAIL_CHECK("case " << i << ": " << along_normal << ", deepest " << deepest
                         << ", least overlap " << oracle.all);
  }
  CHECK(overlapping > 3000);
  CHECK(edges > 500);
}

TEST_CASE("bodies apart: the gap is the distance, the point midway between the closest points") {
  Random random(73);
  int compared[4] = {};
  for (int i = 0; i < 4000; ++i) {
    const PairCase c = random_case(Placement::near_touching, random);
    const Contact contact = contact_of(c.pair(), 1e-3);
    // Where the nearest points lie inside the proven features, no other pair of points is nearer.
    if (contact.points.empty() || contact.axis.separation < 1e-7 || contact.axis.inside < 1e-7)
      continue;
    const Closest closest = closest_points(shape_pool()[c.a], shape_pool()[c.b], c.b_in_a);
    const auto nearest =
        std::min_element(contact.points.begin(), contact.points.end(),
                         [](const auto& p, const auto& q) { return p.gap < q.gap; });
    ++compared[static_cast<int>(contact.axis.feature.kind)];
    const double small = 1e-12 * c.size();
    if (std::abs(nearest->gap - closest.distance) > small)
      FAIL_CHECK("case " << i << ": gap " << nearest->gap << ", distance " << closest.distance);
    if (contact.axis.clearance < 1e-4) continue;  // several points are equally near
    if ((nearest->position - 0.5 * (closest.on_a + closest.on_b)).norm() > 1e-9 * c.size() ||
        (contact.normal - (closest.on_b - closest.on_a) / closest.distance).norm() > 1e-6)
      FAIL_CHECK("case " << i << ": another place than the closest points");
  }
  CHECK(compared[static_cast<int>(AxisKind::face_of_a)] > 50);
  CHECK(compared[static_cast<int>(AxisKind::face_of_b)] > 50);
  CHECK(compared[static_cast<int>(AxisKind::edges)] > 50);
}

TEST_CASE("a plane: its normal, and half a gap from the vertex") {
  const Mat3 rotation = turn(90, Vec3::UnitX());
  CHECK(contact_normal(rotation, Plane{Vec3::UnitY()}).isApprox(Vec3::UnitZ(), 1e-15));
  CHECK(midway_from_b(Vec3(1, 2, 3), 0.5, Vec3::UnitZ()) == Vec3(1, 2, 2.75));
  CHECK(midway_from_a(Vec3(1, 2, 2.5), 0.5, Vec3::UnitZ()) == Vec3(1, 2, 2.75));
}
