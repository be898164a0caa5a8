#include "geometry/shape/clipped_volume.hpp"

#include <cmath>
#include <numbers>

#include "geometry/shape/convex_hull.hpp"
#include "geometry/shape/grain_shapes.hpp"
#include "geometry/shape/mass_properties.hpp"
#include "geometry/shape/pose.hpp"
#include "tests/catch.hpp"

using namespace ballast;

namespace {

struct HalfSpace {
  Vec3 normal;
  double offset;  // inside: normal.x <= offset
};

std::vector<HalfSpace> half_spaces(const Polyhedron& polyhedron, const Pose& pose, const Vec3& lo,
                                   const Vec3& hi) {
  std::vector<HalfSpace> planes;
  for (int f = 0; f < polyhedron.face_count(); ++f) {
    const Vec3 normal = pose.rotation * polyhedron.normal(f);
    planes.push_back({normal, polyhedron.offset(f) + normal.dot(pose.position)});
  }
  for (int axis = 0; axis < 3; ++axis) {
    planes.push_back({Vec3::Unit(axis), hi[axis]});
    planes.push_back({-Vec3::Unit(axis), -lo[axis]});
  }
  return planes;
}

/// Slow and simple: the hull of all points where three planes meet and no plane is exceeded.
double hull_volume(const std::vector<HalfSpace>& planes, double size) {
  std::vector<Vec3> points;
  for (size_t i = 0; i < planes.size(); ++i)
    for (size_t j = i + 1; j < planes.size(); ++j)
      for (size_t k = j + 1; k < planes.size(); ++k) {
        Mat3 normals;
        normals << planes[i].normal.transpose(), planes[j].normal.transpose(),
            planes[k].normal.transpose();
        if (std::abs(normals.determinant()) < 1e-9) continue;
        const Vec3 x =
            normals.inverse() * Vec3(planes[i].offset, planes[j].offset, planes[k].offset);
        bool inside = true;
        for (const HalfSpace& plane : planes)
          inside = inside && plane.normal.dot(x) - plane.offset < 1e-10 * size;
        if (inside) points.push_back(x);
      }
  if (points.size() < 4) return 0.0;
  try {
    return mass_properties(convex_hull(points)).volume;
  } catch (const InvalidPolyhedron&) {
    return 0.0;  // flat
  }
}

Vec3 uniform_point(Random& random, double low, double high) {
  const double x = random.uniform(low, high), y = random.uniform(low, high),
               z = random.uniform(low, high);
  return Vec3(x, y, z);
}

}  // namespace

TEST_CASE("a box in a box: products of overlaps") {
  BoxClipper clipper;
  const Polyhedron cube = make_box(Vec3(2, 2, 2));
  const auto inside = [&](const Vec3& position, const Vec3& lo, const Vec3& hi) {
    return clipper.volume(cube, {position, Quat::Identity()}, lo, hi, 8.0);
  };
  CHECK(inside(Vec3::Zero(), Vec3(-9, -9, -9), Vec3(9, 9, 9)) == 8.0);
  CHECK(inside(Vec3::Zero(), Vec3(0, -9, -9), Vec3(9, 9, 9)) == Approx(4.0).epsilon(1e-14));
  CHECK(inside(Vec3::Zero(), Vec3(0, 0, -9), Vec3(9, 9, 0.5)) == Approx(1.5).epsilon(1e-14));
  CHECK(inside(Vec3(5, 0, 0), Vec3(4.5, -9, -9), Vec3(5.25, 9, 9)) == Approx(3.0).epsilon(1e-14));
  // The small box lies inside the cube: all six planes cut.
  CHECK(inside(Vec3(1, 2, 3), Vec3(0.5, 1.5, 2.5), Vec3(1, 2.25, 3.5)) ==
        Approx(0.375).epsilon(1e-13));
  // The planes touch faces of the cube.
  CHECK(inside(Vec3::Zero(), Vec3(-1, -1, -1), Vec3(1, 1, 1)) == 8.0);
  CHECK(inside(Vec3::Zero(), Vec3(1, -9, -9), Vec3(9, 9, 9)) == 0.0);
  CHECK(inside(Vec3::Zero(), Vec3(-1, -1, -1), Vec3(1, 1, 0)) == Approx(4.0).epsilon(1e-14));
  // Far away, and within the reach of the bounding sphere only.
  CHECK(inside(Vec3(100, 0, 0), Vec3(-1, -1, -1), Vec3(1, 1, 1)) == 0.0);
  CHECK(inside(Vec3(2.5, 0, 0), Vec3(-1, -1, -1), Vec3(1, 1, 1)) == 0.0);
  // A box without thickness.
  CHECK(inside(Vec3::Zero(), Vec3(0, -9, -9), Vec3(0, 9, 9)) == Approx(0.0).margin(1e-15));
}

TEST_CASE("a cube on its edge, cut through vertices") {
  BoxClipper clipper;
  const Polyhedron cube = make_box(Vec3(1, 1, 1));
  const Pose pose{Vec3(3, 4, 5), rotation_by(std::numbers::pi / 4 * Vec3::UnitZ())};
  const double d = std::sqrt(0.5);
  CHECK(clipper.volume(cube, pose, Vec3(3, 0, 0), Vec3(9, 9, 9), 1.0) ==
        Approx(0.5).epsilon(1e-14));
  CHECK(clipper.volume(cube, pose, Vec3(3, 4, 5), Vec3(9, 9, 9), 1.0) ==
        Approx(0.125).epsilon(1e-14));
  // The corner prism beyond x = 3 + d/2: a right triangle of height d/2 and base d.
  CHECK(clipper.volume(cube, pose, Vec3(3 + d / 2, 0, 0), Vec3(9, 9, 9), 1.0) ==
        Approx(d * d / 4).epsilon(1e-13));
}

TEST_CASE("grains against the hull of all points where three planes meet") {
  BoxClipper clipper;
  Random random(11);
  int by_cuts[7] = {};
  for (int trial = 0; trial < 60; ++trial) {
    GrainShapeSettings small;
    small.max_vertices = 20;  // the cost of the oracle is cubic
    const PrincipalShape grain = make_grain(small, 1.0, 100 + trial);
    const Pose pose{uniform_point(random, -1, 1), random_rotation(random)};
    Vec3 lo, hi;
    int cuts = 0;
    for (int axis = 0; axis < 3; ++axis) {
      const double middle = pose.position[axis];
      lo[axis] = random.uniform() < 0.5 ? middle - 3 : middle - random.uniform(-0.3, 0.8);
      hi[axis] = random.uniform() < 0.5 ? middle + 3 : lo[axis] + random.uniform(0.1, 1.0);
      cuts += (lo[axis] > middle - 3) + (hi[axis] < middle + 3);
    }
    ++by_cuts[cuts];
    const double expected = hull_volume(half_spaces(grain.shape, pose, lo, hi), 1.0);
    CHECK(clipper.volume(grain.shape, pose, lo, hi, grain.volume) ==
          Approx(expected).epsilon(1e-9).margin(1e-9 * grain.volume));
  }
  CHECK((by_cuts[1] > 0 && by_cuts[2] > 0 && by_cuts[3] > 0 && by_cuts[4] > 0));
}

TEST_CASE("the pieces of a partition sum to the whole") {
  BoxClipper clipper;
  Random random(12);
  for (int trial = 0; trial < 50; ++trial) {
    const PrincipalShape grain = make_grain({}, 0.05, 500 + trial);
    const Pose pose{uniform_point(random, 0.2, 0.4), random_rotation(random)};
    double ticks[3][5];
    for (int axis = 0; axis < 3; ++axis) {
      ticks[axis][0] = -1.0;
      ticks[axis][4] = 1.0;
      for (int k = 1; k < 4; ++k)
        ticks[axis][k] = pose.position[axis] + random.uniform(-0.05, 0.05);
      std::sort(ticks[axis] + 1, ticks[axis] + 4);
    }
    double sum = 0.0;
    for (int i = 0; i < 4; ++i)
      for (int j = 0; j < 4; ++j)
        for (int k = 0; k < 4; ++k)
          sum +=
              clipper.volume(grain.shape, pose, Vec3(ticks[0][i], ticks[1][j], ticks[2][k]),
                             Vec3(ticks[0][i + 1], ticks[1][j + 1], ticks[2][k + 1]), grain.volume);
    CHECK(sum == Approx(grain.volume).epsilon(1e-11));
  }
}
