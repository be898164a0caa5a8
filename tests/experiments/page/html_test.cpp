#include "experiments/page/html.hpp"

#include "tests/catch.hpp"
#include "tests/experiments/page/small_page.hpp"
#include "tests/support/page_sample.hpp"

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
<footer>The end.</footer>
</main>
</body>
</html>
)");
}

TEST_CASE("lines of a caption are lines") {
  Picture picture = std::get<Picture>(small_page().sections[2].blocks[0]);
  picture.caption.push_back(marked("**Here:** ((more))"));
  CHECK_THAT(html_of(Block(picture)),
             Contains("<i>x</i><br><b>Here:</b> <span class=\"note\">more</span></figcaption>"));
}

TEST_CASE("nested styles are nested tags, opened once") {
  CHECK(html_of(marked("((a *b* c)) **d *e* **`f`")) ==
        "<span class=\"note\">a <i>b</i> c</span> <b>d <i>e</i> </b><code>f</code>");
  CHECK(html_of(verdict(1.0, 2.0)) == "<span class=\"met\">✓ met</span>");
  CHECK(html_of(marked("[a *b*](x?a=1&b)")) == "<a href=\"x?a=1&amp;b\">a <i>b</i></a>");
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
             Folded{hostile, hostile}, Table{hostile, {hostile}, {{hostile}}}}});
  const std::string html = html_of(page);
  check_page(html);
  CHECK_THAT(html, !Contains("<b>&") && !Contains("\x1b") && Contains("&lt;b&gt;&amp;&quot;&#39;"));
}

TEST_CASE("a subheading alone is no section") {
  Page page;
  page.add({"a", "A", {Subheading{"b"}}});
  CHECK_THAT(html_of(page), !Contains("<section"));
}

}  // namespace
}  // namespace ballast::page
