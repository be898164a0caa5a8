#include "geometry/shape/plane_bundles.hpp"

#include <vector>

#include "geometry/shape/convex_hull.hpp"
#include "geometry/shape/random_direction.hpp"
#include "tests/catch.hpp"

using namespace ballast;

namespace {

struct Planes {
  std::vector<Vec3> points, normals;
  std::vector<int> on;
  std::vector<double> allowed;

  int first() const { return first_plane_with_front(points, on, normals, allowed); }
  /// By looking at all points from all planes.
  int slow_first() const {
    for (size_t f = 0; f < normals.size(); ++f)
      for (const Vec3& p : points)
        if (normals[f].dot(p - points[on[f]]) > allowed[f]) return static_cast<int>(f);
    return -1;
  }
};

/// Those of a polyhedron's faces, in any order.
Planes planes_of(const Polyhedron& p, Random& random, double allowed) {
  Planes planes;
  planes.points.assign(p.vertices().begin(), p.vertices().end());
  for (int f = 0; f < p.face_count(); ++f) {
    const size_t at = random.below(planes.on.size() + 1);
    planes.on.insert(planes.on.begin() + at, p.face(f)[0]);
    planes.normals.insert(planes.normals.begin() + at, p.normal(f));
    planes.allowed.push_back(allowed);
  }
  return planes;
}

}  // namespace

TEST_CASE("the first plane that has a point in front is what a look at all pairs finds") {
  Random random(12);
  int clean = 0, dented = 0;
  for (int trial = 0; trial < 120; ++trial) {
    std::vector<Vec3> points;
    for (int i = 0; i < 10 + 4 * trial; ++i) {
      Vec3 p = random_direction(random).cwiseProduct(Vec3(1, 0.7, 0.4));
      if (trial % 3 == 0) p = p.cwiseMin(0.2).cwiseMax(-0.2);  // flat faces, many equal points
      points.push_back(Vec3(1, 2, 3) + p);
    }
    Planes planes = planes_of(convex_hull(points), random, 1e-12);
    CHECK(planes.first() == -1);
    // One vertex, or all of them a little, away from where they were.
    if (trial % 2) {
      planes.points[random.below(planes.points.size())] += 0.1 * random_direction(random);
    } else {
      for (Vec3& p : planes.points) p += random.uniform(0, 1e-11) * random_direction(random);
    }
    CHECK(planes.first() == planes.slow_first());
    (planes.first() < 0 ? clean : dented) += 1;
    for (double& height : planes.allowed) height = random.uniform(0, trial % 4 ? 0.05 : 1e-11);
    CHECK(planes.first() == planes.slow_first());
    (planes.first() < 0 ? clean : dented) += 1;
  }
  CHECK(clean > 5);
  CHECK(dented > 100);
}

TEST_CASE("many planes that are one are answered for, and each by its own allowance") {
  Random random(7);
  Planes planes;
  for (int i = 0; i < 3000; ++i) {
    planes.points.emplace_back(random.uniform(-1, 1), random.uniform(-1, 1), 0.0);
    planes.on.push_back(i);
    planes.normals.push_back(Vec3::UnitZ());
    planes.allowed.push_back(1e-9);
  }
  CHECK(planes.first() == -1);
  planes.points[1234].z() = 2e-9;
  CHECK(planes.first() == 0);
  for (int f = 0; f < 700; ++f) planes.allowed[f] = 3e-9;
  CHECK(planes.first() == 700);
  // Above all the others by half of the points.
  for (int i = 0; i < 3000; i += 2) planes.points[i].z() = 1.0;
  CHECK(planes.first() == 1);
  CHECK(first_plane_with_front({}, {}, {}, {}) == -1);
}
