#include "geometry/shape/point_sets.hpp"

#include "geometry/shape/pose.hpp"
#include "tests/catch.hpp"

using namespace ballast;

TEST_CASE("the first close point is the one that a look at all pairs finds") {
  Random random(17);
  int found = 0;
  for (int trial = 0; trial < 300; ++trial) {
    std::vector<Vec3> points;
    for (int i = 0; i < 60; ++i) {
      // Some points are new, some lie close to an earlier one, some coincide with one.
      if (i == 0 || random.below(2) == 0)
        points.push_back(Vec3(100.0, -7.0, 3.0) + random_direction(random));
      else
        points.push_back(points[random.below(i)] +
                         random.below(3) * 6e-3 * random_direction(random));
    }
    const double reach = 1e-2;
    std::vector<int> expected;
    for (int i = 0; i < 60; ++i) {
      int first = 0;
      while ((points[first] - points[i]).norm() > reach) ++first;
      expected.push_back(first);
      found += first < i;
    }
    CHECK(first_close(points, reach) == expected);
  }
  CHECK(found > 3000);
  CHECK(first_close({}, 1.0).empty());
}
