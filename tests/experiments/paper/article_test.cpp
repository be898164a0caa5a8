// Every number in the article's prose comes from the report.

#include "experiments/paper/sections.hpp"
#include "platform/atomic_file.hpp"
#include "platform/error.hpp"
#include "tests/catch.hpp"
#include "tests/support/temporary_folder.hpp"

using namespace ballast;

TEST_CASE("numbers of the report stand in the prose in Pandoc's notation") {
  const page::Values numbers{{"fig9.high", page::number(1e-4)},
                             {"fig9.low", page::Text("−1.9 [−2, −1.8]")}};
  CHECK(article_of("{{fig9.low}}, not {{fig9.high}}.", numbers) ==
        "−1.9 \\[−2, −1.8\\], not 1.00×10^−4^.");
}

TEST_CASE("a number that the report has not, and a mark that is not closed, are errors") {
  CHECK_THROWS_WITH(article_of("C is {{fig9.c}}.", {}), Catch::Contains("no number fig9.c"));
  CHECK_THROWS_AS(article_of("C is {{fig9.c", {}), std::logic_error);
}

TEST_CASE("the published article has the numbers of the published rows") {
  const TemporaryFolder folder;  // holds no run: all numbers come from the rows
  const std::filesystem::path docs = BALLAST_SOURCE_FOLDER "/docs";
  PaperData data(read_campaign({}), folder.path(),
                 read_runs_csv(docs / "measured" / "campaign_runs.csv"));
  // `ballast paper article --rows docs/measured/campaign_runs.csv --output docs/article`
  CHECK(article_of(make_sections(data, "all")) == read_whole_file(docs / "article" / "article.md"));
}
