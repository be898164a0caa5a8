#include "experiments/page/text.hpp"

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
  CHECK_THROWS_WITH(marked("a", {{"spare", "b"}}), Contains("takes no value {spare}"));
}

TEST_CASE("plain words and labels of plots") {
  const Text text = marked("*f*~max~ = 2×10^−4^ N & x^a^\n");
  CHECK(plain_words(text) == "f_max = 2×10⁻⁴ N & x^a ");
  CHECK(plot_label(text) == "{/:Italic f}_{max} = 2×10^{−4} N \\& x^{a} ");
  CHECK(plot_label("a_b{") == "a\\_b\\{");
}

TEST_CASE("labels of plots are read back as words") {
  CHECK(label_words("{/:Italic f_g}  (N)") ==
        marked("*f*") + Text("g", symbol | subscript) + "\u00a0 (N)");
  CHECK(label_words("|{/:Italic x}_{ref}| 10^{−3} µm") == marked("|*x*~ref~| 10^−3^ µm"));
  for (const char* words : {"a_b{c} <b> ~@&\\^", "λ ≤ 1"})
    CHECK(label_words(plot_label(words)) == words);
  CHECK(label_words("{/:Italic") == "/:Italic");  // unfinished: read to its end
  CHECK(label_words("a_") == "a_");
}

TEST_CASE("what is no UTF-8 and what controls a terminal is replaced") {
  CHECK(clean_utf8("λ ≤ 1 µm\n\t") == "λ ≤ 1 µm\n\t");
  const std::string mark = "\xef\xbf\xbd";
  CHECK(clean_utf8(std::string("a\0b\x1b\x7f", 5)) == "a" + mark + "b" + mark + mark);
  // cut, overlong, surrogate, beyond Unicode, a lone continuation
  for (const char* broken : {"\xe2\x82", "\xc0\xaf", "\xed\xa0\x80", "\xf4\x90\x80\x80", "\x80"})
    CHECK_THAT(clean_utf8(std::string(broken) + "<"), Contains(mark + "<") && !Contains(broken));
}

TEST_CASE("a text is cut at its marks, styles kept, blanks beside them dropped") {
  const std::vector<Text> parts = parts_of(marked("a || *b* c ||  || |v|, d||e"), "||");
  REQUIRE(parts.size() == 5);
  CHECK(parts[0] == Text("a"));
  CHECK(parts[1] == marked("*b* c"));
  CHECK(parts[2].empty());
  CHECK(parts[3] == Text("|v|, d"));  // a single bar is no mark
  CHECK(parts[4] == Text("e"));
  CHECK(parts_of("|| a", "||").front().empty());
  CHECK(parts_of(Text(), "||") == std::vector<Text>(1));
}

}  // namespace
}  // namespace ballast::page
