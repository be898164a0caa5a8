#include "geometry/shape/rounded_hull.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "geometry/shape/convex_hull.hpp"
#include "geometry/shape/random_direction.hpp"
#include "platform/clock.hpp"
#include "tests/catch.hpp"

using namespace ballast;

namespace {

/// The points turned anyhow, and each number as single precision has it.
std::vector<Vec3> rounded(const std::vector<Vec3>& points, Random& random) {
  const Quat turn = random_rotation(random);
  std::vector<Vec3> result;
  for (const Vec3& p : points) result.push_back((turn * p).cast<float>().cast<double>());
  return result;
}

/// With a grid of n x n quads on each face.
std::vector<Vec3> cube_grid(int n) {
  std::vector<Vec3> points;
  for (int i = 0; i <= n; ++i)
    for (int j = 0; j <= n; ++j)
      for (int k = 0; k <= n; ++k)
        if (i % n == 0 || j % n == 0 || k % n == 0) points.emplace_back(i, j, k);
  return points;
}

/// Middles of a cube's edges: squares and triangles, four at each corner.
std::vector<Vec3> cuboctahedron() {
  std::vector<Vec3> points;
  for (const double a : {-1.0, 1.0})
    for (const double b : {-1.0, 1.0})
      points.insert(points.end(), {Vec3(a, b, 0), Vec3(a, 0, b), Vec3(0, a, b)});
  return points;
}

/// A lattice along a spiral on an ellipsoid with these half axes.
std::vector<Vec3> spiral(int count, const Vec3& half_axes) {
  const double golden_angle = std::numbers::pi * (1.0 + std::sqrt(5.0));
  std::vector<Vec3> points;
  for (int k = 0; k < count; ++k) {
    const double z = 1.0 - (2.0 * k + 1.0) / count, radius = std::sqrt(1.0 - z * z);
    const double angle = golden_angle * (k + 0.5);
    points.push_back(
        half_axes.cwiseProduct(Vec3(radius * std::cos(angle), radius * std::sin(angle), z)));
  }
  return points;
}

/// Corners of the solid that the planes p . x = 1 of all points p bound.
std::vector<Vec3> polar_dual(const std::vector<Vec3>& points) {
  const Polyhedron hull = convex_hull(points);
  std::vector<Vec3> corners;
  for (int f = 0; f < hull.face_count(); ++f)
    corners.push_back(hull.normal(f) / hull.normal(f).dot(hull.vertex(hull.face(f)[0])));
  return corners;
}

void check_faces(const std::vector<Vec3>& points, int vertices, int faces) {
  const Polyhedron solid = rounded_hull(points, 1e-6);
  CHECK(solid.vertex_count() == vertices);
  CHECK(solid.face_count() == faces);
  // Each corner is near one of the points.
  for (const Vec3& v : solid.vertices()) {
    double nearest = 1e30;
    for (const Vec3& p : points) nearest = std::min(nearest, (p - v).norm());
    CHECK(nearest < 1e-5);
  }
}

}  // namespace

TEST_CASE("faces that rounding has broken are whole again") {
  Random random(3);
  for (int trial = 0; trial < 20; ++trial) {
    const std::vector<Vec3> cube = rounded(cube_grid(1), random);
    if (trial == 0) CHECK(convex_hull(cube).face_count() > 6);  // what rounding does
    check_faces(cube, 8, 6);
    check_faces(rounded(cube_grid(7), random), 8, 6);
    check_faces(rounded(cuboctahedron(), random), 12, 14);
  }
}

TEST_CASE("what was not broken is the hull as it is") {
  Random random(4);
  std::vector<Vec3> points;
  for (int k = 0; k < 100; ++k) points.push_back(random_direction(random));
  const Polyhedron plain = convex_hull(points), same = rounded_hull(points, 1e-6);
  CHECK(std::equal(plain.vertices().begin(), plain.vertices().end(), same.vertices().begin(),
                   same.vertices().end()));
  CHECK(same.face_count() == plain.face_count());
  CHECK_THROWS_AS(rounded_hull(std::vector<Vec3>(9, Vec3::Zero()), 1e-6), InvalidPolyhedron);
}

TEST_CASE("faces of a smooth surface that cannot be joined are soon left as they are") {
  // Strips of triangles that are nearly flat, and neighbours of strips.
  const std::vector<Vec3> points = spiral(20000, Vec3(1.0, 0.8, 0.6));
  const double begin = processor_seconds();
  const Polyhedron hull = convex_hull(points);
  const double hull_seconds = processor_seconds() - begin;
  CHECK(rounded_hull(hull, 5e-5).face_count() == hull.face_count());
  // 4 hulls' time; all turns would take 50
  CHECK(processor_seconds() - begin - hull_seconds < 20.0 * hull_seconds);
}

TEST_CASE("faces of a solid of many faces are whole again") {
  Random random(5);
  constexpr int faces = 18000;
  const std::vector<Vec3> corners = rounded(polar_dual(spiral(faces, Vec3::Ones())), random);
  // Rounding breaks nearly every hexagon.
  const Polyhedron broken = convex_hull(corners), whole = rounded_hull(broken, 1e-6);
  CHECK(broken.face_count() > 2 * faces);
  CHECK(whole.face_count() == faces);
}

TEST_CASE("triangles give way: a corner moves to larger faces alone") {
  // A square antiprism with a pyramid on one of its squares: only triangles meet at the tip.
  Random random(6);
  for (int trial = 0; trial < 20; ++trial) {
    std::vector<Vec3> points{Vec3(0.0, 0.0, 1.1)};
    for (int k = 0; k < 8; ++k) {
      const double angle = 0.25 * k * std::numbers::pi;
      points.emplace_back(std::cos(angle), std::sin(angle), k % 2 ? 0.4 : -0.4);
    }
    points = rounded(points, random);
    const Polyhedron solid = rounded_hull(points, 1e-6);
    REQUIRE(solid.vertex_count() == 9);
    CHECK(solid.face_count() == 13);
    CHECK(solid.vertex(0) == points[0]);
    // The joined square is flat by moves along its normal.
    for (int v = 1; v < 9; ++v)
      CHECK((solid.vertex(v) - points[static_cast<size_t>(v)]).norm() < 1e-7);
  }
}
