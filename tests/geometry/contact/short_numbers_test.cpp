#include "geometry/contact/short_numbers.hpp"

#include <numeric>

#include "tests/catch.hpp"

using namespace ballast;

TEST_CASE("numbers come back whether two bytes hold them or not") {
  for (const int largest : {0, 7, 65535, 65536, 1 << 30}) {
    std::vector<int> given(100);
    std::iota(given.begin(), given.end(), 0);
    given[50] = largest;
    ShortNumbers kept;
    kept.keep({1 << 20});  // what was there before is forgotten
    kept.keep(given);
    REQUIRE(kept.size() == 100);
    for (int k = 0; k < 100; ++k) CHECK(kept[k] == given[static_cast<size_t>(k)]);
  }
  ShortNumbers none;
  none.keep({});
  CHECK(none.size() == 0);
}
