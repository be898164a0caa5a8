#include <nlohmann/json.hpp>

#include "platform/deflate.hpp"
#include "tests/catch.hpp"
#include "tests/experiments/page/small_page.hpp"
#include "tests/support/page_sample.hpp"
#include "tests/support/temporary_folder.hpp"

namespace ballast::page {
namespace {

using Catch::Matchers::Contains;

TEST_CASE("a small page as HTML, to the letter") {
  const std::string page = html_of(small_page());
  check_page(page);
  CHECK_THAT(page,
             Catch::StartsWith("<!DOCTYPE html>\n") && Contains("<title>A small page</title>"));
  CHECK(page.substr(page.find("<main>")) == R"(<main>
<header>
<h1>A small page</h1>
<p class="lede">2 steps</p>
<p class="lede">made by hand</p>
</header>
<div class="notices" role="note"><b>To be known</b><ul>
<li>no scene.toml</li>
</ul></div>
<section id="numbers">
<h2>In <i>numbers</i></h2>
<h3>h</h3>
<p>A paragraph.</p>
<p>Costs:</p>
<div class="scroll"><table>
<thead><tr><th>phase</th><th class="n"><i>t</i><sub>step</sub><br>(ms)</th></tr>
</thead>
<tbody>
<tr><td>a | b</td><td class="n">1.50</td></tr>
<tr><td><b>all</b></td><td class="n">2.00×10<sup>−4</sup> ms</td></tr>
</tbody></table></div>
<div class="scroll"><table class="facts">
<tbody>
<tr><td>commit</td><td><code>0123</code></td></tr>
</tbody></table></div>
</section>
<section id="rest">
<h2>The rest</h2>
<figure id="wall">
<svg role="img"><title>The wall</title></svg><figcaption><b>Paper:</b> <i>x</i></figcaption>
</figure>
<ul>
<li>one</li>
<li>two</li>
</ul>
<pre>a &lt;b&gt;
```
</pre>
<details><summary>All of it</summary>
<pre>x = 1</pre></details>
</section>
</main>
</body>
</html>
)");
}

TEST_CASE("a page that is asked nothing and moves nothing has no script") {
  Page page = small_page();
  page.add({"motion", "Motion", {Replay{}, Subheading{"b"}}});
  CHECK_THAT(html_of(page), !Contains("<script") && !Contains("Motion"));
}

TEST_CASE("nested styles are nested tags around each run") {
  CHECK(html_of(marked("**d *e***`f`")) == "<b>d </b><b><i>e</i></b><code>f</code>");
  CHECK(html_of(verdict(1.0, 2.0)) == "<span class=\"met\">✓ met</span>");
  CHECK(html_of(marked("[*b*](x?a=1&b)")) == "<a href=\"x?a=1&amp;b\"><i>b</i></a>");
}

TEST_CASE("a cell of more than 40 letters has a least width, however many bytes a letter has") {
  for (const std::string letter : {"a", "µ"}) {
    std::string words;
    for (int k = 0; k < 40; ++k) words += letter;
    CHECK_THAT(html_of(Block(Table{.rows = {{words}}})), !Contains("long"));
    CHECK_THAT(html_of(Block(Table{.rows = {{words + letter}}})), Contains("<td class=\"long\">"));
  }
}

TEST_CASE("words from outside cannot become HTML, wherever they stand") {
  CHECK(escaped_html("<b a=\"1\">&'") == "&lt;b a=&quot;1&quot;&gt;&amp;&#39;");
  CHECK(escaped_html("\x1b") == "\xef\xbf\xbd");
  Page page = small_page();
  page.title = page.lede[0].spans[0].text = hostile;
  page.sections[0].id = "outside";
  page.notices.items[0] = hostile;
  page.add({"words",
            hostile,
            {hostile, Subheading{hostile}, List{{hostile}}, Listing{hostile},
             Listing{hostile, hostile}, Table{hostile, {hostile}, {{hostile}}}}});
  const std::string html = html_of(page);
  check_page(html);
  CHECK_THAT(html, !Contains("<b>&") && !Contains("\x1b") && Contains("&lt;b&gt;&amp;&quot;&#39;"));
}

using Json = nlohmann::json;

Page answering_page() {
  Page page = small_page();
  page.answers = {.is_enabled = true, .has_charts = true};
  Panel& panel = std::get<Picture>(page.sections[2].blocks[0]).plot.panels[0];
  panel.x_label = marked("*t*  (s)");
  panel.log_y = true;
  panel.y_min = 1e-3;
  panel.curves = {{.x = {0.0, 1.0}, .y = {std::nan(""), 1.0 / 3.0}, .title = "a_b</script>"}};
  panel.lines = {{.value = 0.5}};
  return page;
}

TEST_CASE("curves stand in the page as numbers, and nothing in them ends their element") {
  if (!has_chart_library()) return;
  const std::string html = html_of(answering_page());
  check_page(without_scripts(html));
  const Json picture = Json::parse(page_data(html)).at("pictures").at(0),
             panel = picture.at("panels").at(0);
  CHECK(picture["name"] == "wall");
  CHECK(panel["x"]["label"] == "<i>t</i>  (s)");
  CHECK(panel["x"]["words"] == "t  (s)");
  CHECK(panel["y"] == Json{{"label", ""}, {"words", ""}, {"log", true}, {"min", 1e-3}});
  const Json& curve = panel["curves"][0];
  CHECK(curve["title"] == "a_b</script>");  // in plain text, without HTML
  CHECK(curve["ink"] == "blue");
  CHECK(curve["y"] == Json{nullptr, 0.33333});
  CHECK(panel["lines"][0]["value"] == 0.5);
  Page page = answering_page();
  Curve& shown = std::get<Picture>(page.sections[2].blocks[0]).plot.panels[0].curves[0];
  shown.mark = Mark::area;
  shown.y_error = {0.25, 1.0};
  shown.y_low = {0.0, 0.125};
  const Json area =
      Json::parse(page_data(html_of(page))).at("pictures")[0]["panels"][0]["curves"][0];
  CHECK(area["mark"] == "area");
  CHECK((area["error"] == Json{0.25, 1.0} && area["low"] == Json{0.0, 0.125}));
}

TEST_CASE("the page's own data and modules are in it") {
  if (!has_chart_library()) return;
  Page page = answering_page();
  page.answers.data = R"({"a": [1, "<b>"]})";
  page.answers.modules = {"const own = 1;\n"};
  const std::string html = html_of(page);
  CHECK(Json::parse(page_data(html))["a"][1] == "<b>");
  CHECK_THAT(html, Contains("const own = 1;\n})();\n</script>"));
}

TEST_CASE("without the library the page says so") {
  const std::string html = html_of(answering_page());
  CHECK((html.find("libjs-chart.js") != std::string::npos &&
         html.find("<script") == std::string::npos) == !has_chart_library());
}

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
  CHECK(inline_svg("<svg><!-- no end", "a", "t") == "<svg role=\"img\">");  // cut off
  CHECK(inline_svg("", "a", "t").empty());
  CHECK_THAT(part, Contains("<title>x &lt; y &amp; t</title>") && Contains("role=\"img\""));
}

TEST_CASE("every colour that gnuplot writes is one of the page's") {
  if (gnuplot_version().empty()) return;
  const TemporaryFolder folder;
  Panel panel{.x_label = "x", .y_label = "y"};
  for (const Mark mark : {Mark::line, Mark::points, Mark::area})
    panel.curves.push_back({.x = {0.0, 1.0},
                            .y = {1.0, 2.0},
                            .title = "t",
                            .mark = mark,
                            .opacity = 0.5,
                            .y_low = {0.0, 0.0}});
  panel.lines = {{.value = 1.0, .label = "bound"}};
  const std::string svg = render_svg({.name = "a", .panels = {panel}}, folder.path()),
                    style = html_of(Page{});
  size_t count = 0;
  for (size_t at = 0; (at = svg.find("rgb(", at)) != std::string::npos; ++at, ++count)
    CHECK_THAT(style, Contains("=\"" + svg.substr(at, svg.find(')', at) + 1 - at) + "\"]{"));
  CHECK(count > 0);
}

TEST_CASE("a replay stands in one page with its data, its script and a still picture") {
  Page page;
  page.title = "t";
  page.add({"motion",
            "Motion",
            {Replay{.head = "{\"title\":\"</script><b>\"}",
                    .parts = {{"positions", std::string(1000, '\1')}},
                    .still = "\x89PNG",
                    .caption = "What is seen."}}});
  const std::string html = html_of(page);
  check_page(html);
  CHECK_THAT(html, Contains("{\"title\":\"\\u003c/script>\\u003cb>\"}</script>"));
  CHECK_THAT(html, Contains("id=\"replay-positions\">" +
                            base64(deflated(std::string(1000, '\1'), 9)) + "</script>"));
  CHECK_THAT(html, Contains("src=\"data:image/png;base64," + base64("\x89PNG") + "\""));
  CHECK_THAT(html, Contains("<figcaption>What is seen.</figcaption>"));
  // The page has every module once.
  for (const char* name :
       {"class Data ", "class Camera ", "class Stage ", "class Plots ", "class Replay "})
    CHECK((html.find(name) != std::string::npos && html.find(name) == html.rfind(name)));
}

}  // namespace
}  // namespace ballast::page
