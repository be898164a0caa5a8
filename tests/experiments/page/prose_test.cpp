#include "experiments/page/prose.hpp"

#include <stdexcept>

#include "experiments/page/page.hpp"
#include "tests/catch.hpp"

namespace ballast::page {
namespace {

using Catch::Matchers::Contains;

TEST_CASE("named paragraphs of text files, lines joined, values filled in") {
  const Prose texts{"# first\n\nOne line,\nand *another*.\n\nBroken.\n\n# second\n{x} mm\n",
                    "# third\na\n"};
  CHECK(texts("first") == marked("One line, and *another*.\nBroken."));
  CHECK(texts("second", {{"x", number(1.5)}}) == Text("1.50 mm"));
  CHECK(texts("third") == Text("a"));
  CHECK(texts("third", {{"x", "of another text"}}) == Text("a"));
}

TEST_CASE("a table's words are its caption and the cells of its head") {
  // an entry that the program has
  const Table table = words_table("fig3.table");
  CHECK_THAT(plain_words(table.caption), Contains("First contraction"));
  REQUIRE(table.head.size() == 4);
  CHECK(plain_words(table.head[2]) == "size (mm)");
  CHECK(table.rows.empty());
  CHECK_THROWS_WITH(words("fig2.table"), Contains("fig2.table"));
}

TEST_CASE("faults of text files are said by name") {
  const Prose texts{"# a\nneeds {x}\n"};
  CHECK_THROWS_WITH(texts("b"), Contains("there is no \"b\""));
  CHECK_THROWS_WITH(texts("a"), Contains("{x}") && Contains("needs"));
  CHECK_THROWS_WITH((Prose{"# a\nx\n", "# a\ny\n"}), Contains("\"a\" stands twice"));
  CHECK_THROWS_WITH((Prose{"words\n# a\n"}), Contains("no headline before \"words\""));
}

}  // namespace
}  // namespace ballast::page
