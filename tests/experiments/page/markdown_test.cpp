#include "tests/catch.hpp"
#include "tests/experiments/page/small_page.hpp"

namespace ballast::page {
namespace {

TEST_CASE("a small page as Markdown, to the letter") {
  Page page = small_page();
  for (Section& section : page.sections)
    std::erase_if(section.blocks, [](const Block& block) {
      return std::holds_alternative<Subheading>(block) || std::holds_alternative<Listing>(block);
    });
  CHECK(markdown_of(page) == R"(# A small page

2 steps

made by hand

**To be known**

**no scene.toml**

## In *numbers*

A paragraph.

Costs:

| phase | *t*<sub>step</sub><br>(ms) |
|---|---:|
| a \| b | 1.50 |
| **all** | 2.00×10<sup>−4</sup> ms |

|  |  |
|---|---|
| commit | `0123` |

## The rest

![The wall](figures/wall.svg)

[PDF](<figures/wall.pdf>)

**Paper:** *x*

- one
- two
)");
}

TEST_CASE("characters that Markdown reads are escaped, and only those") {
  const auto written = [](const char* words) { return markdown_of(Text(words)); };
  CHECK(written("f_max ~ ν^−2, [1.1, 1.4], C ~ 0.01") == "f_max ~ ν^−2, [1.1, 1.4], C ~ 0.01");
  CHECK(written("_x_ *y* `z` a|b \\") == "\\_x\\_ \\*y\\* \\`z\\` a\\|b \\\\");
  CHECK(written("[a](b) [a][b] ~~c~~ $x$") == "[a\\](b) [a\\][b] \\~\\~c\\~\\~ \\$x\\$");
  CHECK(written("<script>&amp;") == "&lt;script>&amp;amp;");
  CHECK(written("# no heading") == "\\# no heading");
  CHECK(written("> a") == "&gt; a");
  CHECK(written("a\nb\x1b") == "a<br>b\xef\xbf\xbd");
  CHECK(markdown_of(Text("a`b|c", code)) == "`a'b\\|c`");
}

TEST_CASE("a block that no page in Markdown has is a fault of the program") {
  CHECK_THROWS_AS(markdown_of(small_page()), std::logic_error);
}

TEST_CASE("a cell cannot end its row") {
  Table table;
  table.head = {hostile};
  table.rows = {{"a|b\nc", Text("x|y", code)}};
  const std::string text = markdown_of(Block(table));
  CHECK(std::count(text.begin(), text.end(), '\n') == 4);  // head, rule, row, end
  const std::string row = "| a\\|b<br>c | `x\\|y` |";
  CHECK_THAT(text, Catch::Contains(row));
}

TEST_CASE("marks stand at words, not at spaces") {
  CHECK(markdown_of(marked("a** b **c")) == "a **b** c");
  CHECK(markdown_of(marked("**Cost against *W*.** more")) == "**Cost against *W*.** more");
}

}  // namespace
}  // namespace ballast::page
