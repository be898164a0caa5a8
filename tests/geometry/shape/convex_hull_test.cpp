#include "geometry/shape/convex_hull.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <set>

#include "geometry/shape/mass_properties.hpp"
#include "geometry/shape/pose.hpp"
#include "tests/catch.hpp"
#include "tests/support/captured_errors.hpp"
#include "tests/support/complaint.hpp"

using namespace ballast;

namespace {

/// The reason why the points have no hull; empty if they have one.
std::string defect(const std::vector<Vec3>& points) {
  return complaint<InvalidPolyhedron>([&] { convex_hull(points); });
}

/// The vertex sets of the faces by definition: planes through three points with all others on one
/// side.
std::set<std::set<int>> faces_by_definition(const std::vector<Vec3>& points) {
  const int n = static_cast<int>(points.size());
  std::set<std::set<int>> faces;
  for (int i = 0; i < n; ++i) {
    for (int j = 0; j < n; ++j) {
      for (int k = j + 1; k < n; ++k) {
        if (i == j || i == k) continue;
        const Vec3 normal = (points[j] - points[i]).cross(points[k] - points[i]).normalized();
        std::set<int> on;
        bool one_side = true;
        for (int m = 0; m < n; ++m) {
          const double height = normal.dot(points[m] - points[i]);
          if (std::abs(height) < 1e-9) on.insert(m);
          one_side = one_side && height < 1e-9;
        }
        if (one_side) faces.insert(on);
      }
    }
  }
  return faces;
}

std::set<std::set<int>> faces_of(const Polyhedron& p) {
  std::set<std::set<int>> faces;
  for (int f = 0; f < p.face_count(); ++f)
    faces.insert(std::set<int>(p.face(f).begin(), p.face(f).end()));
  return faces;
}

/// The largest height of a point above the polyhedron's faces, over the circumradius.
double worst_outside(const Polyhedron& hull, const std::vector<Vec3>& points) {
  double worst = 0.0;
  for (const Vec3& p : points)
    for (int f = 0; f < hull.face_count(); ++f)
      worst = std::max(worst, hull.normal(f).dot(p - hull.vertex(hull.face(f)[0])));
  return worst / hull.circumradius();
}

std::vector<Vec3> cube_corners() {
  const Polyhedron box = make_box({2, 2, 2});
  return {box.vertices().begin(), box.vertices().end()};
}

}  // namespace

TEST_CASE("a cube's corners give six quadrilaterals, in any orientation") {
  Random random(1);
  for (int trial = 0; trial < 200; ++trial) {
    const Quat turn = trial == 0 ? Quat::Identity() : random_rotation(random);
    std::vector<Vec3> points = cube_corners();
    for (Vec3& p : points) p = turn * p + Vec3(trial, 0, 0);
    const Polyhedron hull = convex_hull(points);
    REQUIRE(hull.face_count() == 6);
    REQUIRE(hull.vertex_count() == 8);
    for (int v = 0; v < 8; ++v) CHECK(hull.vertex(v) == points[v]);
    CHECK(mass_properties(hull).volume == Approx(8.0).epsilon(1e-12));
  }
}

TEST_CASE("points inside, on edges and on faces, and duplicates are dropped, the order is kept") {
  const std::vector<Vec3> corners = cube_corners();
  std::vector<Vec3> points = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0.5, -0.5, 1}};
  points.insert(points.end(), corners.begin(), corners.end());
  points.insert(points.end(), {{1, 1, 1}, {-1, -1, 1 + 1e-12}, {-0.3, 0.2, 0.9}, {-1, -1, 0.7}});
  const Polyhedron hull = convex_hull(points);
  REQUIRE(hull.vertex_count() == 8);
  for (int v = 0; v < 8; ++v) CHECK(hull.vertex(v) == corners[v]);
  CHECK(hull.face_count() == 6);
}

TEST_CASE("faces agree with the definition of a hull") {
  Random random(2);
  for (int trial = 0; trial < 60; ++trial) {
    std::vector<Vec3> points;
    // Every third set is from a lattice, with many coplanar points.
    for (int i = 0; i < 14; ++i)
      points.push_back(trial % 3 ? random_direction(random)
                                 : Vec3(random.below(3), random.below(3), random.below(3)));
    if (trial % 3 == 0) {
      std::sort(points.begin(), points.end(), [](const Vec3& a, const Vec3& b) {
        return std::lexicographical_compare(a.begin(), a.end(), b.begin(), b.end());
      });
      points.erase(std::unique(points.begin(), points.end()), points.end());
    }
    const Polyhedron hull = convex_hull(points);
    // The definition holds for the hull's vertices, and no point is outside the hull.
    CHECK(faces_of(hull) == faces_by_definition({hull.vertices().begin(), hull.vertices().end()}));
    CHECK(worst_outside(hull, points) < 1e-12);
    if (trial % 3) CHECK(hull.vertex_count() == 14);
  }
}

TEST_CASE("the same points give the same bits, their order changes only the numbering") {
  Random random(4);
  std::vector<Vec3> points;
  for (int i = 0; i < 40; ++i) points.push_back(random_direction(random));
  const Polyhedron once = convex_hull(points), again = convex_hull(points);
  REQUIRE(once.face_count() == again.face_count());
  for (int f = 0; f < once.face_count(); ++f) {
    const std::vector<int> loop(once.face(f).begin(), once.face(f).end());
    CHECK(std::equal(loop.begin(), loop.end(), again.face(f).begin(), again.face(f).end()));
    CHECK(*std::min_element(loop.begin(), loop.end()) == loop.front());
    if (f > 0) CHECK(std::vector<int>(once.face(f - 1).begin(), once.face(f - 1).end()) < loop);
    CHECK(once.normal(f) == again.normal(f));
  }
  std::vector<Vec3> reversed(points.rbegin(), points.rend());
  std::set<std::set<int>> renamed;
  for (const auto& face : faces_of(convex_hull(reversed))) {
    std::set<int> other;
    for (const int v : face) other.insert(39 - v);
    renamed.insert(other);
  }
  CHECK(renamed == faces_of(once));
}

TEST_CASE("cubes and lattices with noise of any size have a hull that holds every point") {
  Random random(5);
  for (int trial = 0; trial < 3000; ++trial) {
    const double noise = std::pow(10.0, -random.uniform(2.0, 17.0));
    const Quat turn = random_rotation(random);
    const int n = 2 + trial % 3;
    std::vector<Vec3> points;
    for (int x = 0; x < n; ++x)
      for (int y = 0; y < n; ++y)
        for (int z = 0; z < n; ++z)
          points.push_back(turn * Vec3(x, y, z) +
                           noise * Vec3(random.normal(), random.normal(), random.normal()));
    CAPTURE(trial, noise, n);
    REQUIRE(defect(points) == "");
    const Polyhedron hull = convex_hull(points);
    CHECK(worst_outside(hull, points) < 2e-8);
    if (noise < 1e-12) CHECK(hull.face_count() == 6);
  }
}

TEST_CASE("scale and place change nothing") {
  for (const double scale : {1e-9, 1.0, 1e9}) {
    for (const double shift : {0.0, 1e4}) {
      std::vector<Vec3> points = cube_corners();
      for (Vec3& p : points) p = scale * (p + Vec3(shift, shift, -shift));
      CHECK(convex_hull(points).face_count() == 6);
    }
  }
}

TEST_CASE("sets without a hull say why, and qhull stays silent") {
  const CapturedErrors captured;
  struct Case {
    std::vector<Vec3> points;
    std::string said;
  };
  constexpr double infinite = std::numeric_limits<double>::infinity();
  std::vector<Case> table{
      {{}, "at least 4 points are needed, got 0"},
      {{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, "at least 4 points are needed, got 3"},
      {{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, std::nan(""), 1}},
       "point 3 has a coordinate that is NaN"},
      {{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, infinite}}, "NaN or infinite"},
      {std::vector<Vec3>(9, Vec3(1, 2, 3)), "all points coincide"},
      {{{0, 0, 0}, {1, 1, 1}, {2, 2, 2}, {5, 5, 5}, {-1, -1, -1}}, "lie on one line"},
      {{{0, 0, 0}, {1, 0, 1}, {0, 1, 1}, {1, 1, 2}, {3, 1, 4}}, "lie in one plane"},
      {{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 1e-12}}, "lie in one plane"},
      {{{0, 0, 0}, {1e200, 0, 0}, {0, 1, 0}, {1, 1, 1}}, "overflows"}};
  // Points on the diagonals of a cube, with noise of qhull's merging radius, for seeds with which
  // qhull 2020.2 gives up and wants to print it. The second attempt succeeds.
  for (const int seed : {5459, 5625, 9887, 53207}) {
    Random random(seed);
    const double noise = random.uniform(4e-10, 1e-9);
    std::vector<Vec3> points;
    for (int i = 0; i < 58; ++i) {
      Vec3 ends[2];
      for (Vec3& end : ends)
        for (double& x : end) x = random.below(2);
      const double t = random.uniform();
      points.push_back(ends[0] + t * (ends[1] - ends[0]) + noise * random_direction(random));
    }
    table.push_back({points, ""});
  }
  for (const auto& [points, said] : table) {
    const std::string found = defect(points);
    CHECK_THAT(found, Catch::Contains(said));
    CHECK(found.empty() == said.empty());
  }
  CHECK(captured.bytes() == 0);
}

namespace {

/// The points turned by a random rotation, with each number rounded to single precision.
std::vector<Vec3> rounded(const std::vector<Vec3>& points, Random& random) {
  const Quat turn = random_rotation(random);
  std::vector<Vec3> result;
  for (const Vec3& p : points) result.push_back((turn * p).cast<float>().cast<double>());
  return result;
}

/// A cube with a grid of n x n quads on each face.
std::vector<Vec3> cube_grid(int n) {
  std::vector<Vec3> points;
  for (int i = 0; i <= n; ++i)
    for (int j = 0; j <= n; ++j)
      for (int k = 0; k <= n; ++k)
        if (i % n == 0 || j % n == 0 || k % n == 0) points.emplace_back(i, j, k);
  return points;
}

/// The middles of a cube's edges: faces are squares and triangles, four at each corner.
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

/// The corners of the solid that is bounded by the planes p . x = 1 of all points p.
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
    if (trial == 0) CHECK(convex_hull(cube).face_count() > 6);  // rounding breaks the faces
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

TEST_CASE("faces of a solid of many faces are whole again, a smooth surface is left as it is") {
  Random random(5);
  constexpr int faces = 1000;
  const std::vector<Vec3> corners = rounded(polar_dual(spiral(faces, Vec3::Ones())), random);
  // Rounding breaks nearly every hexagon.
  CHECK(convex_hull(corners).face_count() > 2 * faces - 200);
  CHECK(rounded_hull(corners, 1e-6).face_count() == faces);
  // A hull with strips of nearly flat triangles, some beside each other.
  const std::vector<Vec3> smooth = spiral(2000, Vec3(1.0, 0.8, 0.6));
  CHECK(rounded_hull(smooth, 5e-5).face_count() == convex_hull(smooth).face_count());
}

TEST_CASE("triangles give way: a corner moves to larger faces alone") {
  // A square antiprism with a pyramid on one square: only triangles meet at its tip.
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
    // The joined square becomes plane by moves along its normal.
    for (int v = 1; v < 9; ++v)
      CHECK((solid.vertex(v) - points[static_cast<size_t>(v)]).norm() < 1e-7);
  }
}
