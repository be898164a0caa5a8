#include "experiments/page/html.hpp"
#include "tests/catch.hpp"

namespace ballast::page {
namespace {

using Catch::Matchers::Contains;

TEST_CASE("an inlined SVG has ids of its own and nothing that points outside") {
  const std::string svg =
      "<?xml version=\"1.0\"?>\n<!DOCTYPE svg PUBLIC \"-//W3C//DTD SVG 1.1//EN\" "
      "\"http://www.w3.org/Graphics/SVG/1.1/DTD/svg11.dtd\">\n"
      "<svg xmlns=\"http://www.w3.org/2000/svg\"><title>gnuplot</title><desc>made by "
      "http://elsewhere</desc><!-- see http://there -->"
      "<path id='gpPt0' stroke='rgb(  0, 114, 178)'/><g id=\"b\"/><use xlink:href='#gpPt0'/><g "
      "filter='url(#b)'/></svg>";
  const std::string part = inline_svg(svg, "fig03", "x < y & t");
  CHECK_THAT(part, !Contains("<?xml") && !Contains("DOCTYPE") && !Contains("elsewhere") &&
                       !Contains("there"));
  CHECK_THAT(part, Contains("id='fig03-gpPt0'") && Contains("id=\"fig03-b\"") &&
                       Contains("href='#fig03-gpPt0'") && Contains("url(#fig03-b)"));
  CHECK_THAT(part, Contains("rgb(0,114,178)") && Contains("<title>x &lt; y &amp; t</title>") &&
                       Contains("role=\"img\""));
}

TEST_CASE("damaged SVG is cut, not copied") {
  CHECK(inline_svg("<svg><!-- no end", "a", "t") == "<svg role=\"img\">");
  CHECK(inline_svg("", "a", "t").empty());
}

}  // namespace
}  // namespace ballast::page
