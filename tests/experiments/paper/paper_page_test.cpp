#include "experiments/page/html.hpp"
#include "experiments/page/markdown.hpp"
#include "experiments/paper/paper_report.hpp"
#include "tests/catch.hpp"
#include "tests/support/page_sample.hpp"

namespace ballast {
namespace {

using Catch::Matchers::Contains;

PaperSection sample_section() {
  PaperSection section;
  section.id = "fig9";
  section.heading = "Figure 9 <again>";
  section.notes = {"PARTIAL: 1 of 2"};
  section.text = {page::marked("About *x*.")};
  section.figures = {{.plot = {.name = "fig09", .title = "A title", .panels = {Panel{}}},
                      .caption = {"what the paper says", "falls | too"},
                      .files = page::Text("PDF", 0, "figures/fig09.pdf")}};
  section.tables = {{"Means", {"ν", "a|b"}, {{"1", page::with_error(1.5, 0.25)}}}};
  const Found sharp{.value = -2.0, .low = -2.01, .high = -1.99};
  section.rows = {{"Fig. 9", "x ~ ν^−2", page::number(-2.0), PaperRange::exponent(-2.0), sharp,
                   Agreement::agrees},
                  {"Fig. 9", "y", "no", PaperRange::exponent(1.0), sharp, Agreement::differs}};
  section.findings = {{"beyond", "something"}};
  return section;
}

TEST_CASE("both pages say the same words") {
  const page::Page page = paper_page({sample_section()}, {"1 of 2 runs are finished."});
  const std::string html = html_of(page), markdown = markdown_of(page);
  check_page(html);
  for (const char* words : {"PARTIAL: 1 of 2", "1 of 2 runs are finished.", "Means:", "1.50 ± 0.25",
                            "DIFFERS", "x ~ ν^−2", "What was run", "Azéma"}) {
    CHECK_THAT(html, Contains(words));
    CHECK_THAT(markdown, Contains(words));
  }
  CHECK_THAT(html,
             Contains("Figure 9 &lt;again&gt;") && Contains("what the paper says<br>falls | too"));
  CHECK_THAT(markdown, Contains("| Fig. 9 | y | DIFFERS | no | 0.9 … 1.1 | −2.00 [−2.01, −1.99") &&
                           Contains("**PARTIAL: 1 of 2**"));
  const std::string head = "| ν | a\\|b |", found = "falls \\| too";
  CHECK_THAT(markdown, Contains(head) && Contains(found));
  CHECK_THAT(markdown,
             Contains("![A title](figures/fig09.svg)") && Contains("[PDF](<figures/fig09.pdf>)"));
}

TEST_CASE("what was found stands before the sections, row by row") {
  const page::Page page = paper_page({sample_section(), sample_section()}, {});
  REQUIRE(page.sections.at(1).id == "agreement");
  const auto& table = std::get<page::Table>(page.sections.at(1).blocks.at(1));
  REQUIRE(table.rows.size() == 4);
  CHECK(plain_words(table.rows[0][3]) == "−2.00");
  CHECK(plain_words(table.rows[3][2]) == "DIFFERS");
  REQUIRE(page.sections.at(2).id == "beyond");
  const auto& beyond = std::get<page::Table>(page.sections.at(2).blocks.at(0));
  REQUIRE(beyond.rows.size() == 2);
  CHECK(plain_words(beyond.rows[0][1]) == "something");
}

}  // namespace
}  // namespace ballast
