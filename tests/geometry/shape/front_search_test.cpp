#include "geometry/shape/front_search.hpp"

#include <algorithm>

#include "geometry/shape/random_direction.hpp"
#include "tests/catch.hpp"

using namespace ballast;

TEST_CASE("the points in front of a cone are those that a look at all points finds") {
  Random random(5);
  size_t found = 0, looks = 0;
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
      FrontSearch::Cone cone;
      cone.normal = k % 3 ? random_direction(random) : flat;
      cone.origin = points[random.below(points.size())];
      // through a point, a hair above it, far away; a plane, nearly a plane, wide
      for (const double height : {0.0, 1e-13, 1e-9, random.uniform(-1, 2)}) {
        cone.height = height;
        cone.spread = k % 2 ? 0.0 : k % 4 ? 1e-6 : random.uniform(0, 2);
        std::vector<int> expected, visited;
        for (size_t i = 0; i < points.size(); ++i)
          if (cone.has_in_front(points[i])) expected.push_back(static_cast<int>(i));
        search.visit_in_front(cone, [&](int i) {
          visited.push_back(i);
          return true;
        });
        std::sort(visited.begin(), visited.end());
        CHECK(visited == expected);
        found += visited.size();
        looks += points.size();
        // One is enough for who asks whether there is any.
        size_t first = 0;
        search.visit_in_front(cone, [&](int) { return ++first < 1; });
        CHECK(first == std::min<size_t>(1, expected.size()));
      }
    }
  }
  CHECK(found > looks / 10);
  CHECK(found < looks * 9 / 10);
  FrontSearch({}).visit_in_front({Vec3::UnitX(), Vec3::Zero(), 0.0, -1.0}, [](int) {
    FAIL("there is no point");
    return true;
  });
}

TEST_CASE("a cone holds what is in front of any of its planes") {
  const FrontSearch::Cone cone{Vec3::UnitZ(), Vec3(1, 2, 3), 0.1, 0.5};
  CHECK(cone.has_in_front(Vec3(1, 2, 3.6)));
  CHECK_FALSE(cone.has_in_front(Vec3(1, 2, 3.45)));
  CHECK(cone.has_in_front(Vec3(5, 2, 3.15)));  // 0.15 + 0.1 * 4 > 0.5
  CHECK_FALSE(cone.has_in_front(Vec3(5, 2, 3.05)));
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
