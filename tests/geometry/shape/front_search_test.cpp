#include "geometry/shape/front_search.hpp"

#include "geometry/shape/random_direction.hpp"
#include "tests/catch.hpp"

using namespace ballast;

namespace {

bool brute(const std::vector<Vec3>& points, const Vec3& normal, const Vec3& origin, double height) {
  for (const Vec3& p : points)
    if (normal.dot(p - origin) > height) return true;
  return false;
}

}  // namespace

TEST_CASE("a point in front of a plane is found exactly where a look at all points finds one") {
  Random random(5);
  int found = 0, cases = 0;
  for (int trial = 0; trial < 60; ++trial) {
    std::vector<Vec3> points;
    const Vec3 flat = random_direction(random);
    for (int i = 0; i < 1 + 10 * trial; ++i) {
      Vec3 p = random_direction(random);
      // on a sphere, in a plane, in a ball, in one place
      if (trial % 4 == 1) p -= flat.dot(p) * flat;
      if (trial % 4 == 2) p *= random.uniform(0, 1);
      if (trial % 4 == 3) p = flat;
      points.push_back(Vec3(3, -2, 1) + p);
    }
    const FrontSearch search(points);
    for (int k = 0; k < 50; ++k) {
      const Vec3 normal = k % 3 ? random_direction(random) : flat;
      const Vec3& origin = points[random.below(points.size())];
      // through a point, a hair above it, far away
      for (const double height : {0.0, 1e-13, 1e-9, random.uniform(-1, 2)}) {
        const bool expected = brute(points, normal, origin, height);
        CHECK(search.any_in_front(normal, origin, height) == expected);
        found += expected;
        ++cases;
      }
    }
  }
  CHECK(found > cases / 10);
  CHECK(found < cases * 9 / 10);
  CHECK_FALSE(FrontSearch({}).any_in_front(Vec3::UnitX(), Vec3::Zero(), -1.0));
}

TEST_CASE("the highest point along a direction is found, though not all are looked at") {
  Random random(8);
  std::vector<Vec3> points;
  for (int i = 0; i < 3000; ++i) points.push_back(Vec3(1, 2, 3) + random_direction(random));
  const FrontSearch search(points);
  for (int trial = 0; trial < 200; ++trial) {
    const Vec3 direction = random.uniform(0.1, 3.0) * random_direction(random);
    double highest = -1e30, found = -1e30;
    for (const Vec3& p : points) highest = std::max(highest, direction.dot(p));
    int looks = 0;
    search.visit_higher(direction, found, [&](int i) {
      ++looks;
      return found = std::max(found, direction.dot(points[static_cast<size_t>(i)]));
    });
    CHECK(found == highest);
    CHECK(looks < 1500);
    // Nothing is higher than the highest.
    search.visit_higher(direction, highest * (1.0 + 1e-12), [&](int i) {
      CHECK(direction.dot(points[static_cast<size_t>(i)]) <= highest);
      return highest;
    });
  }
}
