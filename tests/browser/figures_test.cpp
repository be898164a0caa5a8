// The figures and tables of any page in a real browser.

#include "experiments/page/page.hpp"
#include "platform/atomic_file.hpp"
#include "platform/text.hpp"
#include "tests/browser/driven_box.hpp"

namespace ballast {
namespace {

using Json = Browser::Json;

/// A page with two curves in one panel, and a table as wide as the paper's.
page::Page wide_page() {
  page::Picture picture;
  Panel panel{.x_label = "x", .y_label = "y", .y_min = 0.0, .y_max = 2.0};
  const std::vector<double> x{0, 1, 2}, y{1, 1, 1};
  panel.curves = {
      {.x = x, .y = y, .title = "below", .ink = Ink::blue, .width = 2.0},
      {.x = x, .y = y, .title = page::marked("above *f*~g~"), .ink = Ink::vermilion, .width = 4.0}};
  panel.lines = {{1.5, page::marked("asked: *x*")}};
  // The curve has two pieces: the point between them has neither x nor y.
  const double none = std::nan("");
  panel.curves.push_back({.x = {0, 0.5, none, 1.5, 2},
                          .y = {0.5, 0.5, none, 0.5, 0.5},
                          .title = "pieces",
                          .ink = Ink::black,
                          .width = 4.0});
  page::Table table;
  table.head = {"figure", "paper", "agreement", "Ballast", "taken as", "judged by"};
  const std::string found = "exponent 0.863 [0.836, 0.890] (R² 0.9956, 22 points), χ²/dof 4.0";
  table.rows = {{"Fig. 11, Eq. 3", "one line through all the series that were varied", "partly",
                 found, "0.495 … 0.505", found + "; the law misses the points"}};
  picture.plot = {.name = "two", .title = "Two curves", .panels = {panel}};
  page::Page page{.title = "Wide"};
  page.answers = {.is_enabled = true, .has_charts = true};
  page.add({"table", "Table", {table}});
  page.add({"figure", "Figure", {picture}});
  return page;
}

/// A page with one figure that answers.
std::filesystem::path page_of(const Panel& panel, const std::string& name,
                              const TemporaryFolder& folder) {
  page::Picture picture;
  picture.plot = {.name = name, .title = name, .panels = {panel}};
  page::Page page{.title = name};
  page.answers = {.is_enabled = true, .has_charts = true};
  page.add({"figure", "Figure", {picture}});
  page::draw_pictures(page, folder.path());
  write_whole_file(folder.path() / "page.html", html_of(page));
  return folder.path() / "page.html";
}

}  // namespace

TEST_CASE("later curves stand above earlier ones, and no column is cut where there is room") {
  if (Browser::is_missing() || !page::has_chart_library() || gnuplot_version().empty()) return;
  const TemporaryFolder folder;
  page::Page page = wide_page();
  page::draw_pictures(page, folder.path());
  write_whole_file(folder.path() / "page.html", html_of(page));
  Browser browser(1400, 900);
  browser.open(folder.path() / "page.html", "", "document.querySelector('#two canvas')");
  CHECK(browser.js("(() => { const c = Chart.getChart(document.querySelector('#two canvas')), "
                   "{ x, y } = c.scales; return [...c.ctx.getImageData(x.getPixelForValue(0.5), "
                   "y.getPixelForValue(1), 1, 1).data]; })()") == Json{0xd5, 0x5e, 0x00, 0xff});
  CHECK(browser.js("[...document.querySelectorAll('.switch')].map((s) => s.textContent)") ==
        Json{"below", "above f_g", "pieces"});
  // The curve is interrupted where it has no value.
  for (const auto& [x, is_drawn] : {std::pair{0.25, true}, {0.95, false}, {1.75, true}})
    CHECK(browser.js(printed("(() => { const c = Chart.getChart(document.querySelector('#two "
                             "canvas')), { x, y } = c.scales; return c.ctx.getImageData("
                             "x.getPixelForValue(%g), y.getPixelForValue(0.5), 1, 1).data[3] === "
                             "255; })()",
                             x)) == is_drawn);
  // The words stand above the line, in the soft colour.
  CHECK(browser.js("(() => { const c = Chart.getChart(document.querySelector('#two canvas')), "
                   "y = c.scales.y.getPixelForValue(1.5), right = c.chartArea.right; const b = "
                   "c.ctx.getImageData(right - 60, y - 15, 56, 12).data; let dark = 0; "
                   "for (let k = 0; k < b.length; k += 4) dark += b[k + 3] > 0 && b[k] < 140; "
                   "return dark > 20; })()") == true);
  CHECK(browser.js("(() => { const s = document.querySelector('.scroll'); return s.scrollWidth <= "
                   "s.clientWidth; })()") == true);
}

TEST_CASE("a logarithmic axis ends beside its points, and only round values have numbers") {
  if (Browser::is_missing() || !page::has_chart_library() || gnuplot_version().empty()) return;
  const TemporaryFolder folder;
  Panel panel{.x_label = "x", .y_label = "y", .log_x = true, .log_y = true};
  panel.curves = {{.x = {0.006, 0.02, 0.036}, .y = {6, 7, 9}, .mark = Mark::points}};
  panel.lines = {{.value = 0.02, .vertical = true}};
  Browser browser(1400, 900);
  browser.open(page_of(panel, "log", folder), "", "document.querySelector('#log canvas')");
  const auto numbers = [&](const std::string& axis) {
    return browser.js("Chart.getChart(document.querySelector('#log canvas')).scales." + axis +
                      ".ticks.map((tick) => tick.label).filter(Boolean)");
  };
  CHECK(numbers("x") == Json{"0.01", "0.02"});
  CHECK(numbers("y") == Json{"6", "7", "8", "9"});
}

TEST_CASE("an axis has room for error bars and for the low side of bands") {
  if (Browser::is_missing() || !page::has_chart_library() || gnuplot_version().empty()) return;
  const TemporaryFolder folder;
  Panel panel{.x_label = "x", .y_label = "y"};
  panel.curves = {{.x = {0, 1, 2}, .y = {1, 2, 2.5}, .mark = Mark::points, .y_error = {0, 3, 0}},
                  {.x = {0, 1, 2}, .y = {1, 1, 1}, .mark = Mark::area, .y_low = {-5, 0, 0}}};
  Browser browser(1400, 900);
  browser.open(page_of(panel, "bars", folder), "", "document.querySelector('#bars canvas')");
  CHECK(browser.js("(() => { const { y } = Chart.getChart(document.querySelector('#bars canvas'))"
                   ".scales; return [y.min <= -5, y.max >= 5]; })()") == Json{true, true});
}

TEST_CASE("the figures of a run tell the values under the pointer") {
  if (Browser::is_missing() || !page::has_chart_library() || gnuplot_version().empty()) return;
  const DrivenBox& box = driven_box();
  Browser browser(1400, 900);
  browser.open(box.page(), "play=0", is_ready);
  browser.wait_for(
      "document.querySelector('#error canvas') && "
      "Chart.getChart(document.querySelector('#error canvas'))");
  // Points at the rms error of the tenth step.
  const Json spot = browser.js(
      "(() => { const c = document.querySelector('#error canvas'); c.scrollIntoView({block: "
      "'center'}); const p = Chart.getChart(c).getDatasetMeta(1).data[9], b = "
      "c.getBoundingClientRect(); return [b.left + p.x, b.top + p.y]; })()");
  browser.hover(spot[0], spot[1]);
  browser.wait_for("document.querySelector('#error .said').textContent.includes('rms')");
  const std::string said = browser.js("document.querySelector('#error .said').textContent");
  CHECK_THAT(said, Catch::Contains(printed("t %.3g", box.steps[9].time)));
  // Tables in groups keep their order; other tables can be sorted.
  CHECK(browser.js("document.querySelectorAll('#results .sort').length") == 0);
  CHECK(browser.js("document.querySelectorAll('#cost-table .sort').length") == 3);
  CHECK(browser.js("document.scrollingElement.scrollWidth") == 1400);
}

}  // namespace ballast
