#include "geometry/shape/sorted_by_key.hpp"

#include "tests/catch.hpp"

using namespace ballast;

TEST_CASE("positions come by key, those of one key in their order") {
  const std::vector<int> keys{2, 0, 3, 2, 0, 2};
  const SortedByKey sorted = sorted_by_key(keys, 5);
  CHECK(sorted.order == std::vector{1, 4, 0, 3, 5, 2});
  CHECK(sorted.begin == std::vector{0, 2, 2, 5, 6, 6});
  CHECK(sorted.of(2).size() == 3);
  CHECK(sorted.of(2)[1] == 3);
  CHECK(sorted.of(1).empty());
  CHECK(sorted_by_key({}, 2).begin == std::vector{0, 0, 0});
}
