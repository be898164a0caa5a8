#include "experiments/page/text.hpp"

#include <limits>

#include "experiments/measure/curve_fit.hpp"
#include "experiments/page/page.hpp"
#include "tests/catch.hpp"

namespace ballast::page {
namespace {

using Catch::Matchers::Contains;

TEST_CASE("the notation gives runs with styles, and nothing else does") {
  const Text text = marked("**Force** *f*~g~ above 10^−3^ `a*b` ((see *x*)) \\*");
  const std::vector<Span> expected = {{"Force", strong, ""},
                                      {" ", 0, ""},
                                      {"f", symbol, ""},
                                      {"g", subscript, ""},
                                      {" above 10", 0, ""},
                                      {"−3", superscript, ""},
                                      {" ", 0, ""},
                                      {"a*b", code, ""},
                                      {" ", 0, ""},
                                      {"see ", note, ""},
                                      {"x", note | symbol, ""},
                                      {" *", 0, ""}};
  CHECK(text.spans == expected);
  CHECK(Text("**Force** {x} `").spans == std::vector<Span>{{"**Force** {x} `", 0, ""}});
}

TEST_CASE("links, and brackets that are none") {
  CHECK(marked("see [the *data*](d/x.csv).").spans ==
        std::vector<Span>{
            {"see ", 0, ""}, {"the ", 0, "d/x.csv"}, {"data", symbol, "d/x.csv"}, {".", 0, ""}});
  CHECK(marked("[1.1, 1.4]") == Text("[1.1, 1.4]"));
}

TEST_CASE("values are put in as they are, in the style around them") {
  const Text hostile = "*a* {b} [x](y)";
  CHECK(marked("is **{it}**", {{"it", hostile}}).spans ==
        std::vector<Span>{{"is ", 0, ""}, {"*a* {b} [x](y)", strong, ""}});
}

TEST_CASE("faults of a notation are said with the text") {
  for (const char* wrong :
       {"**bold", "*f", "a `b", "((a", "a))", "{x", "{missing}", "[a *b](c)*", "[a](b"})
    CHECK_THROWS_WITH(marked(wrong), Contains(wrong));
}

TEST_CASE("a document is filled where it asks, and with nothing that it does not ask for") {
  const auto twice = [](const std::string& words) { return words + words; };
  CHECK(page::filled("{{a}} and {{b c}}, {d} }}", twice) == "aa and b cb c, {d} }}");
  CHECK(page::filled("{{x}}", [](const std::string&) { return "{{y}}"; }) == "{{y}}");
  CHECK_THROWS_WITH(page::filled("{{a}} {{b", twice), "{{ without }}");
}

TEST_CASE("plain words") {
  const Text text = marked("*f*~max~ = 2×10^−4^ N & x^a^\n");
  CHECK(plain_words(text) == "f_max = 2×10⁻⁴ N & x^a ");
}

TEST_CASE("what is no UTF-8 and what controls a terminal is replaced") {
  CHECK(clean_utf8("λ ≤ 1 µm\n\t") == "λ ≤ 1 µm\n\t");
  const std::string mark = "\xef\xbf\xbd";
  CHECK(clean_utf8(std::string("a\0b\x1b\x7f", 5)) == "a" + mark + "b" + mark + mark);
  // Cut off, overlong, a surrogate, beyond Unicode, a lone continuation byte.
  for (const char* broken : {"\xe2\x82", "\xc0\xaf", "\xed\xa0\x80", "\xf4\x90\x80\x80", "\x80"})
    CHECK_THAT(clean_utf8(std::string(broken) + "<"), Contains(mark + "<") && !Contains(broken));
}

TEST_CASE("a text is cut at its marks, styles kept, blanks beside them dropped") {
  const std::vector<Text> parts = parts_of(marked("a || *b* c ||  || |v|, d||e"), "||");
  REQUIRE(parts.size() == 5);
  CHECK(parts[0] == Text("a"));
  CHECK(parts[1] == marked("*b* c"));
  CHECK(parts[2].empty());
  CHECK(parts[3] == Text("|v|, d"));  // a single bar does not cut
  CHECK(parts[4] == Text("e"));
  CHECK(parts_of("|| a", "||").front().empty());
  CHECK(parts_of(Text(), "||") == std::vector<Text>(1));
}

TEST_CASE("numbers as a reader wants them") {
  const auto text = [](double value, int digits = 3) { return plain_words(number(value, digits)); };
  CHECK(text(0.0) == "0");
  CHECK(text(1.23456) == "1.23");
  CHECK(text(0.00123456) == "0.00123");
  CHECK(text(0.000123456) == "1.23×10⁻⁴");
  CHECK(text(-17.96) == "−18.0");
  CHECK(text(123456.0) == "123456");
  CHECK(text(999999.9) == "1.00×10⁶");
  CHECK(text(0.0009999) == "0.00100");
  CHECK(text(5.0e-324, 2) == "4.9×10⁻³²⁴");
  CHECK(number(1e-9, 1).spans == std::vector<Span>{{"1×10", 0, ""}, {"−9", superscript, ""}});
}

TEST_CASE("what is not known is a dash, with no unit and no error") {
  const Text dash("–", note);
  const double infinite = std::numeric_limits<double>::infinity();
  for (const double value : {not_known, infinite, -infinite}) {
    CHECK(number(value) == dash);
    CHECK(exact(value) == dash);
    CHECK(quantity(value, "mm") == dash);
    CHECK(exact_quantity(value, "mm") == dash);
    CHECK(with_error(value, 1.0) == dash);
    CHECK(percent(value) == dash);
  }
  CHECK(interval(not_known, 2.0) == "[" + dash + ", 2.00]");
}

TEST_CASE("settings without trailing zeros, units, errors, deviations, intervals, verdicts") {
  CHECK(plain_words(exact(1200.0)) == "1200");
  CHECK(exact(size_t{1200}) == exact(1200.0));
  CHECK(plain_words(exact(2e-4)) == "2×10⁻⁴");
  CHECK(plain_words(exact(-0.54)) == "−0.54");
  CHECK(plain_words(exact(1e6)) == "1×10⁶");
  CHECK(quantity(0.25, "mm", 2) == Text("0.25\u202fmm"));
  CHECK(quantity(2.0, "m s^−2^") == "2.00\u202fm s" + Text("−2", superscript));
  CHECK(exact_quantity(0.25, "") == Text("0.25"));
  CHECK(plain_words(with_error(1.23456, 0.0421)) == "1.235 ± 0.042");
  CHECK(plain_words(with_error(123.4, 5.6)) == "123.4 ± 5.6");
  CHECK(plain_words(with_error(-0.5, 0.12)) == "−0.50 ± 0.12");
  CHECK(plain_words(with_error(1.5, not_known)) == "1.50");
  CHECK(plain_words(with_error(1e8, 2e7)) == "1.00×10⁸ ± 2.0×10⁷");
  CHECK(plain_words(percent(0.0312)) == "+3.1 %");
  CHECK(plain_words(percent(-0.12)) == "−12 %");
  CHECK(plain_words(interval(-1.1, 1.4)) == "[−1.10, 1.40]");
  CHECK(verdict(1e-3, 1e-3) == Text("✓ met", good));
  CHECK(verdict(1.1e-3, 1e-3) == Text("✗ missed", bad));
  CHECK((verdict(not_known, 1e-3).empty() && verdict(1.0, not_known).empty()));
}

TEST_CASE("named paragraphs of text files, lines joined, values filled in") {
  const auto entries = entries_of(
      "# first\n\nOne line,\nand *another*.\n\nBroken.\n\n# second\n{x} mm\n# third\na\n");
  const auto texts = [&](const char* name, const Values& values = {}) {
    return marked(entries.at(name), values);
  };
  CHECK(texts("first") == marked("One line, and *another*.\nBroken."));
  CHECK(texts("second", {{"x", number(1.5)}}) == Text("1.50 mm"));
  CHECK(texts("third") == Text("a"));
  CHECK(texts("third", {{"x", "of another text"}}) == Text("a"));
  CHECK_THROWS_WITH(words("b"), Contains("there is no \"b\""));
  CHECK_THROWS_WITH(texts("second"), Contains("{x}") && Contains("mm"));
  CHECK_THROWS_WITH(entries_of("# a\nx\n# a\ny\n"), Contains("\"a\" stands twice"));
  CHECK_THROWS_WITH(entries_of("words\n# a\n"), Contains("no headline before \"words\""));
}

TEST_CASE("a table's words are its caption and the cells of its head") {
  // An entry that exists.
  const Table table = words_table("fig4.table");
  CHECK_THAT(plain_words(table.caption), Contains("sample by sample"));
  REQUIRE(table.head.size() == 10);
  CHECK(plain_words(table.head[2]) == "growth over the stroke (exp)");
  CHECK(table.rows.empty());
  CHECK_THROWS_WITH(words("fig2.table"), Contains("fig2.table"));
}

}  // namespace
}  // namespace ballast::page
