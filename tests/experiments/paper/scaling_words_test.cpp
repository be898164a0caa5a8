#include <cmath>

#include "experiments/paper/sections.hpp"
#include "tests/catch.hpp"

namespace ballast {
namespace {

TEST_CASE("a law's misfit is about one, and has its p, where the points scatter as their errors") {
  const VariedCurve on{{1, 2, 4, 8}, {1.1, 1.9, 4.3, 7.7}, {0.1, 0.2, 0.4, 0.8}, 8},
      off{{1, 2, 4, 8}, {1.0, 1.0, 8.0, 8.0}, {0.05, 0.05, 0.4, 0.4}, 8};
  const Misfit good = misfit_of(fit_power(on.x, on.y), on),
               bad = misfit_of(fit_power(off.x, off.y), off);
  CHECK(good.reduced < 2.0);
  CHECK(good.p > 0.1);
  CHECK(bad.reduced > 10.0);
  CHECK(bad.p < 0.01);
  CHECK_THAT(plain_words(words_of(bad)),
             Catch::StartsWith("χ²/dof ") && Catch::Contains(", p < 1e-4"));
  CHECK(plain_words(words_of_p(1e-9)) == "< 1e-4");
}

TEST_CASE("a power law is found and said with its interval") {
  const std::vector<double> x = {1, 2, 4, 8};
  std::vector<double> y;
  for (const double value : x) y.push_back(3.0 * std::pow(value, -2.0));
  const std::string words = plain_words(words_of(fit_power(x, y)));
  CHECK_THAT(words,
             Catch::StartsWith("−2.00 [−2.00, −2.00]") && Catch::Contains("R² 1.000, 4 points"));
  CHECK(plain_words(words_of(PowerFit{})) == "–");
}

}  // namespace
}  // namespace ballast
