#include <cmath>

#include "experiments/paper/sections.hpp"
#include "tests/catch.hpp"

namespace ballast {
namespace {

TEST_CASE("an exponent agrees when it is near, or its sharp interval holds the expected one") {
  PowerFit fit;
  fit.exponent = -1.93;
  fit.half_width = 0.01;
  CHECK(judge_exponent(fit, -2.0) == Agreement::agrees);  // within 0.1
  fit.exponent = -1.75;
  CHECK(judge_exponent(fit, -2.0) == Agreement::partly);  // within 0.3
  fit.half_width = 0.4;
  CHECK(judge_exponent(fit, -2.0) == Agreement::agrees);  // the interval holds −2
  fit.half_width = 1.5;                                   // and would hold anything
  CHECK(judge_exponent(fit, -2.0) == Agreement::partly);
  fit.exponent = -1.5;
  fit.half_width = 0.1;
  CHECK(judge_exponent(fit, -2.0) == Agreement::differs);
  fit.half_width = not_known;
  CHECK(judge_exponent(fit, -2.0) == Agreement::reported);
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
