#include "geometry/shape/mass_properties.hpp"

#include <cmath>

#include "geometry/shape/convex_hull.hpp"
#include "geometry/shape/grain_shapes.hpp"
#include "geometry/shape/pose.hpp"
#include "tests/catch.hpp"

using namespace ballast;

namespace {

Polyhedron moved_copy(const Polyhedron& p, const Pose& pose, double scale = 1.0) {
  std::vector<Vec3> vertices;
  for (const Vec3& x : p.vertices()) vertices.push_back(pose * Vec3(scale * x));
  return p.with_vertices(vertices);
}

/// The part of a convex polyhedron with normal.x <= offset: the hull of the vertices there and of
/// the points where edges are cut.
Polyhedron cut(const Polyhedron& p, const Vec3& normal, double offset) {
  std::vector<Vec3> points;
  for (const Vec3& x : p.vertices())
    if (normal.dot(x) <= offset) points.push_back(x);
  for (const auto& edge : p.edges()) {
    const Vec3 &a = p.vertex(edge.tail), &b = p.vertex(edge.head);
    const double ha = normal.dot(a) - offset, hb = normal.dot(b) - offset;
    if (ha * hb < 0.0) points.push_back(a + ha / (ha - hb) * (b - a));
  }
  return convex_hull(points);
}

Mat3 parallel_axis(double mass, const Vec3& d) {
  return mass * (d.squaredNorm() * Mat3::Identity() - d * d.transpose());
}

double off_diagonal(const Mat3& m) {
  return std::max({std::abs(m(0, 1)), std::abs(m(0, 2)), std::abs(m(1, 2))});
}

}  // namespace

TEST_CASE("a box") {
  const MassProperties box = mass_properties(make_box({1.0, 2.0, 3.0}));
  CHECK(box.volume == Approx(6.0).epsilon(1e-15));
  CHECK(box.centre.norm() < 1e-15);
  const Mat3 expected = Vec3(6.5, 5.0, 2.5).asDiagonal();  // m (b^2 + c^2) / 12
  CHECK((box.inertia - expected).norm() < 1e-14);
}

TEST_CASE("a tetrahedron against Tonon's formulas") {
  // A corner at the origin with legs a, b, c: the integral of x^2 is V a^2 / 10, of xy V ab / 20.
  const double a = 2.0, b = 3.0, c = 5.0, V = a * b * c / 6.0;
  const Polyhedron p({{0, 0, 0}, {a, 0, 0}, {0, b, 0}, {0, 0, c}},
                     {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {0, 3, 2}});
  const MassProperties got = mass_properties(p);
  CHECK(got.volume == Approx(V).epsilon(1e-14));
  const Vec3 centre = Vec3(a, b, c) / 4.0;
  CHECK((got.centre - centre).norm() < 1e-14);
  Mat3 about_corner;
  about_corner << b * b + c * c, -a * b / 2, -a * c / 2, -a * b / 2, a * a + c * c, -b * c / 2,
      -a * c / 2, -b * c / 2, a * a + b * b;
  about_corner *= V / 10.0;
  const Mat3 expected = about_corner - parallel_axis(V, centre);
  CHECK((got.inertia - expected).norm() < 1e-13 * expected.norm());
}

TEST_CASE("rotation, translation and scale follow their laws") {
  Random random(1);
  for (int seed = 0; seed < 50; ++seed) {
    const Polyhedron grain =
        moved_copy(make_grain({}, 1.0, seed).shape, {{0.1, 0.2, 0.3}, random_rotation(random)});
    const MassProperties before = mass_properties(grain);
    const Pose pose{3.0 * random_direction(random), random_rotation(random)};
    const MassProperties after = mass_properties(moved_copy(grain, pose, 2.0));
    const Mat3 R = pose.rotation.toRotationMatrix();
    CHECK(after.volume == Approx(8.0 * before.volume).epsilon(1e-13));
    CHECK((after.centre - (pose * Vec3(2.0 * before.centre))).norm() < 1e-13);
    CHECK((after.inertia - 32.0 * R * before.inertia * R.transpose()).norm() <
          1e-12 * after.inertia.norm());
  }
}

TEST_CASE("the two pieces of a cut grain add up to the whole") {
  Random random(2);
  for (int seed = 0; seed < 100; ++seed) {
    const Polyhedron grain = make_grain({}, 1.0, seed).shape;
    const Vec3 normal = random_direction(random);
    const double offset = random.uniform(-0.5, 0.5) * grain.inradius();
    const MassProperties whole = mass_properties(grain);
    const MassProperties a = mass_properties(cut(grain, normal, offset));
    const MassProperties b = mass_properties(cut(grain, -normal, -offset));
    CHECK(a.volume > 0.05 * whole.volume);
    CHECK(b.volume > 0.05 * whole.volume);
    CHECK(a.volume + b.volume == Approx(whole.volume).epsilon(1e-9));
    CHECK((a.volume * a.centre + b.volume * b.centre - whole.volume * whole.centre).norm() <
          1e-9 * whole.volume);
    const Mat3 sum = a.inertia + parallel_axis(a.volume, a.centre - whole.centre) + b.inertia +
                     parallel_axis(b.volume, b.centre - whole.centre);
    CHECK((sum - whole.inertia).norm() < 1e-9 * whole.inertia.norm());
  }
}

TEST_CASE("an upright box stays upright in its principal frame") {
  const PrincipalShape p =
      to_principal_frame(moved_copy(make_box({3.0, 1.0, 2.0}), {{5, 6, 7}, Quat::Identity()}));
  CHECK(p.pose.rotation.coeffs() == Quat::Identity().coeffs());
  CHECK((p.pose.position - Vec3(5, 6, 7)).norm() < 1e-14);
  for (int f = 0; f < 6; ++f) CHECK(p.shape.normal(f).cwiseAbs().maxCoeff() == 1.0);
  CHECK((p.inertia - Vec3(2.5, 6.5, 5.0)).norm() < 1e-13);
}

TEST_CASE("the principal frame of grains anywhere") {
  Random random(3);
  for (int seed = 0; seed < 200; ++seed) {
    const double distance = seed % 2 ? 100.0 : 0.1;
    const Polyhedron given =
        moved_copy(make_grain({}, 1.0, seed).shape,
                   {distance * random_direction(random), random_rotation(random)});
    const PrincipalShape p = to_principal_frame(given);
    const MassProperties again = mass_properties(p.shape);
    CHECK(again.volume == p.volume);
    CHECK(again.centre.norm() < 1e-15);
    CHECK(off_diagonal(again.inertia) < 2e-15);
    CHECK(again.inertia.diagonal() == p.inertia);
    CHECK(p.inertia.x() <= p.inertia.y());
    CHECK(p.inertia.y() <= p.inertia.z());
    CHECK(p.pose.rotation.norm() == Approx(1.0).epsilon(1e-15));
    // The pose moves every vertex back to its place; it is a proper motion.
    for (int v = 0; v < given.vertex_count(); ++v)
      CHECK((p.pose * p.shape.vertex(v) - given.vertex(v)).norm() < 1e-14 * (distance + 1.0));
    CHECK(p.volume == Approx(mass_properties(given).volume).epsilon(1e-12));
  }
}

TEST_CASE("solids without distinct axes have a principal frame too") {
  Random random(4);
  for (int trial = 0; trial < 20; ++trial) {
    const Pose pose{random_direction(random), random_rotation(random)};
    for (const Polyhedron& solid :
         {make_box({2, 2, 2}), make_box({2, 2, 1}), make_sphere(1.0, 2)}) {
      const PrincipalShape p = to_principal_frame(moved_copy(solid, pose));
      const MassProperties again = mass_properties(p.shape);
      CHECK(off_diagonal(again.inertia) < 1e-12 * p.inertia.maxCoeff());
      CHECK(again.centre.norm() < 1e-15);
    }
  }
}
