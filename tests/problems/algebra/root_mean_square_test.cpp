#include "problems/algebra/root_mean_square.hpp"

#include <cmath>

#include "tests/catch.hpp"

using namespace ballast;

TEST_CASE("A root mean square is of single values, squares and parts alike; of nothing zero") {
  RootMeanSquare whole, part, other;
  CHECK(whole.value() == 0.0);
  for (const double value : {1.0, -2.0, 4.0}) whole.add(value);
  part.add_square(1.0);
  other.add(2.0);
  other.add_square(16.0);
  part.add(other);
  CHECK(part.value() == whole.value());
  CHECK(whole.value() == Approx(std::sqrt(7.0)));
}
