// The article: every number in its prose comes from the report.

#include "experiments/paper/article.hpp"

#include "platform/error.hpp"
#include "tests/catch.hpp"

using namespace ballast;

TEST_CASE("numbers of the report stand in the prose in Pandoc's notation") {
  const page::Values numbers{{"fig9.high", page::number(1e-4)},
                             {"fig9.low", page::Text("−1.9 [−2, −1.8]")}};
  CHECK(article_of("{{fig9.low}}, not {{fig9.high}}.", numbers) ==
        "−1.9 \\[−2, −1.8\\], not 1.00×10^−4^.");
}

TEST_CASE("a number that the report has not, and a mark that is not closed, are errors") {
  CHECK_THROWS_WITH(article_of("C is {{fig9.c}}.", {}), Catch::Contains("no number fig9.c"));
  CHECK_THROWS_AS(article_of("C is {{fig9.c", {}), Error);
}
