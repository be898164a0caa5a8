#include "problems/algebra/root_mean_square.hpp"

#include <cmath>

#include "tests/catch.hpp"

using namespace ballast;

TEST_CASE("The root mean square of nothing is zero, of equal values their size", "[root_mean]") {
  RootMeanSquare mean;
  CHECK(mean.value() == 0.0);
  for (int k = 0; k < 5; ++k) mean.add(k % 2 == 0 ? 3.0 : -3.0);
  CHECK(mean.value() == 3.0);
}

TEST_CASE("Parts and squares weigh as their single values do", "[root_mean]") {
  RootMeanSquare whole, part, other;
  for (const double value : {1.0, 2.0, 4.0}) whole.add(value);
  part.add_square(1.0);
  other.add(2.0);
  other.add_square(16.0);
  part.add(other);
  CHECK(part.value() == whole.value());
  CHECK(whole.value() == Approx(std::sqrt(7.0)));
}
