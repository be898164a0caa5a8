#include "geometry/shape/close_pairs.hpp"

#include <algorithm>

#include "geometry/shape/random_direction.hpp"
#include "tests/catch.hpp"

using namespace ballast;

TEST_CASE("close pairs are those that a look at all pairs finds") {
  Random random(17);
  int found = 0;
  for (int trial = 0; trial < 300; ++trial) {
    std::vector<Vec3> points;
    for (int i = 0; i < 60; ++i) {
      // some points anew, some a little beside an earlier one, some in the same place
      if (i == 0 || random.below(2) == 0)
        points.push_back(Vec3(100.0, -7.0, 3.0) + random_direction(random));
      else
        points.push_back(points[random.below(i)] +
                         random.below(3) * 6e-3 * random_direction(random));
    }
    const double reach = 1e-2;
    std::vector<std::pair<int, int>> expected;
    for (int i = 0; i < 60; ++i)
      for (int j = i + 1; j < 60; ++j)
        if ((points[i] - points[j]).norm() <= reach) expected.emplace_back(i, j);
    std::vector<std::pair<int, int>> pairs = close_pairs(points, reach);
    std::sort(pairs.begin(), pairs.end());
    CHECK(pairs == expected);
    found += static_cast<int>(pairs.size());
  }
  CHECK(found > 3000);
  CHECK(close_pairs({}, 1.0).empty());
}
