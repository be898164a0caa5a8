// The script of a page that answers, as text; what it does is tested in a browser.

#include <cmath>

#include <nlohmann/json.hpp>

#include "experiments/page/html.hpp"
#include "tests/catch.hpp"
#include "tests/experiments/page/small_page.hpp"
#include "tests/support/page_sample.hpp"

namespace ballast::page {
namespace {

using Catch::Matchers::Contains;
using Json = nlohmann::json;

/// What stands in the page's element of data.
Json data_in(const std::string& html) {
  const size_t begin = html.find('>', html.find("id=\"page-data\"")) + 1;
  const std::string text = html.substr(begin, html.find("</script>", begin) - begin);
  CHECK_THAT(text, !Contains("<"));
  return Json::parse(text);
}

Page answering_page() {
  Page page = small_page();
  page.answers = {.are_given = true, .with_curves = true};
  Panel& panel = std::get<Picture>(page.sections[2].blocks[0]).plot.panels[0];
  panel.x_label = "{/:Italic t}  (s)";
  panel.log_y = true;
  panel.y_min = 1e-3;
  panel.curves = {{.x = {0.0, 1.0}, .y = {std::nan(""), 1.0 / 3.0}, .title = "a\\_b</script>"}};
  panel.lines = {{.value = 0.5}};
  return page;
}

TEST_CASE("a page that is asked nothing has no script") {
  CHECK(answers_html(small_page()).empty());
  CHECK_THAT(html_of(small_page()), !Contains("<script"));
}

TEST_CASE("curves stand in the page as numbers, and nothing in them ends their element") {
  if (!can_answer()) return;
  const std::string html = html_of(answering_page());
  check_page(without_scripts(html));
  const Json picture = data_in(html).at("pictures").at(0), panel = picture.at("panels").at(0);
  CHECK(picture["name"] == "wall");
  CHECK(panel["x"]["label"] == "<i>t</i>\u00a0 (s)");
  CHECK(panel["x"]["words"] == "t\u00a0 (s)");
  CHECK(panel["y"] == Json{{"label", ""}, {"words", ""}, {"log", true}, {"min", 1e-3}});
  const Json& curve = panel["curves"][0];
  CHECK(curve["title"] == "a_b</script>");  // as it is read, no HTML
  CHECK(curve["ink"] == "blue");
  CHECK(curve["y"] == Json{nullptr, 0.33333});
  CHECK(panel["lines"][0]["value"] == 0.5);
}

TEST_CASE("bars of errors and lower bounds of areas go with the numbers of their points") {
  if (!can_answer()) return;
  Page page = answering_page();
  Curve& curve = std::get<Picture>(page.sections[2].blocks[0]).plot.panels[0].curves[0];
  curve.y_error = {0.25, 1.0};
  const Json pictures = data_in(html_of(page)).at("pictures");
  CHECK(pictures.at(0)["panels"][0]["curves"][0]["error"] == Json{0.25, 1.0});
  curve.mark = Mark::area;
  curve.y_low = {0.0, 0.125};
  const Json area = data_in(html_of(page)).at("pictures")[0]["panels"][0]["curves"][0];
  CHECK(area["mark"] == "area");
  CHECK(area["low"] == Json{0.0, 0.125});
}

TEST_CASE("the page's own data and modules are in it") {
  if (!can_answer()) return;
  Page page = answering_page();
  page.answers.data = R"({"a": [1, "<b>"]})";
  page.answers.modules = {"const own = 1;\n"};
  const std::string html = html_of(page);
  CHECK(data_in(html)["a"][1] == "<b>");
  CHECK_THAT(html, Contains("const own = 1;\n})();\n</script>"));
}

TEST_CASE("without the library the page says so") {
  const std::string html = html_of(answering_page());
  CHECK((html.find("libjs-chart.js") != std::string::npos &&
         html.find("<script") == std::string::npos) == !can_answer());
}

}  // namespace
}  // namespace ballast::page
