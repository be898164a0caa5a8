#include "experiments/page/html_page.hpp"

#include <limits>

#include "experiments/measure/curve_fit.hpp"
#include "experiments/run_page/report_origin.hpp"
#include "tests/catch.hpp"

namespace ballast {
namespace {

using Catch::Matchers::Contains;

TEST_CASE("text from outside is escaped") {
  CHECK(escaped("<b a=\"1\">&'").markup == "&lt;b a=&quot;1&quot;&gt;&amp;&#39;");
  CHECK(escaped("λ ≤ 1 µm").markup == "λ ≤ 1 µm");
  CHECK(escaped(std::string("a\0b\x1b", 4)).markup ==
        "a\xef\xbf\xbd"
        "b\xef\xbf\xbd");
  // cut, overlong, surrogate, beyond Unicode, a lone continuation
  for (const char* broken : {"\xe2\x82", "\xc0\xaf", "\xed\xa0\x80", "\xf4\x90\x80\x80", "\x80"}) {
    const std::string markup = escaped(std::string(broken) + "<").markup;
    CHECK_THAT(markup, Contains("\xef\xbf\xbd") && Contains("&lt;") && !Contains(broken));
  }
}

TEST_CASE("numbers as a reader wants them") {
  CHECK(number(0.0).markup == "0");
  CHECK(number(1.23456).markup == "1.23");
  CHECK(number(0.00123456).markup == "0.00123");
  CHECK(number(0.000123456).markup == "1.23×10<sup>−4</sup>");
  CHECK(number(-17.96).markup == "−18.0");
  CHECK(number(123456.0).markup == "123456");
  CHECK(number(999999.9).markup == "1.00×10<sup>6</sup>");
  CHECK(number(0.0009999).markup == "0.00100");
  CHECK(number(5.0e-324, 2).markup == "4.9×10<sup>−324</sup>");
  CHECK_THAT(number(not_known).markup, Contains("–"));
  CHECK_THAT(number(std::numeric_limits<double>::infinity()).markup, Contains("–"));
  CHECK(exact(1200.0).markup == "1200");
  CHECK(exact(2e-4).markup == "2×10<sup>−4</sup>");
  CHECK(exact(0.54).markup == "0.54");
  CHECK(exact(-100.0).markup == "−100");
  CHECK(quantity(0.25, "mm", 2).markup == "0.25&#8239;mm");
}

TEST_CASE("verdicts") {
  CHECK_THAT(verdict(1e-3, 1e-3).markup, Contains("✓") && Contains("met"));
  CHECK_THAT(verdict(1.1e-3, 1e-3).markup, Contains("✗") && Contains("missed"));
  CHECK(verdict(not_known, 1e-3).markup.empty());
}

TEST_CASE("an inlined SVG has ids of its own and nothing that points outside") {
  const std::string svg =
      "<?xml version=\"1.0\"?>\n<!DOCTYPE svg PUBLIC \"-//W3C//DTD SVG 1.1//EN\" "
      "\"http://www.w3.org/Graphics/SVG/1.1/DTD/svg11.dtd\">\n"
      "<svg xmlns=\"http://www.w3.org/2000/svg\"><title>gnuplot</title><desc>made by "
      "http://elsewhere</desc><!-- see http://there -->"
      "<path id='gpPt0' stroke='rgb(  0, 114, 178)'/><g id=\"b\"/><use xlink:href='#gpPt0'/><g "
      "filter='url(#b)'/></svg>";
  const std::string markup = inline_svg(svg, "fig03", "x < y & t").markup;
  CHECK_THAT(markup, !Contains("<?xml") && !Contains("DOCTYPE") && !Contains("elsewhere") &&
                         !Contains("there"));
  CHECK_THAT(markup, Contains("id='fig03-gpPt0'") && Contains("id=\"fig03-b\"") &&
                         Contains("href='#fig03-gpPt0'") && Contains("url(#fig03-b)"));
  CHECK_THAT(markup, Contains("rgb(0,114,178)") && Contains("<title>x &lt; y &amp; t</title>") &&
                         Contains("role=\"img\""));
}

TEST_CASE("tables") {
  HtmlTable table;
  table.head = {{"what"}, {"m"}};
  table.rows = {{escaped("a<b"), number(2.0)}};
  table.is_number = {false, true};
  CHECK_THAT(to_html(table).markup,
             Contains("<th>what</th>") && Contains("<td>a&lt;b</td><td class=\"n\">2.00</td>"));
}

TEST_CASE("words for a shell") {
  CHECK(shell_word("drive.frequency=5") == "drive.frequency=5");
  CHECK(shell_word("a b") == "'a b'");
  CHECK(shell_word("it's $HOME") == "'it'\\''s $HOME'");
  CHECK(shell_word("") == "''");
}

}  // namespace
}  // namespace ballast
