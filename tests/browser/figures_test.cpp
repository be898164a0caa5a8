// Figures and tables of any page in a real browser.

#include "experiments/page/drawing.hpp"
#include "experiments/page/html.hpp"
#include "experiments/page/plot.hpp"
#include "platform/atomic_file.hpp"
#include "tests/support/browser.hpp"

namespace ballast {
namespace {

using Json = Browser::Json;

/// Two curves in one place, and a table as wide as the paper's.
page::Page wide_page() {
  page::Picture picture;
  Panel panel{.x_label = "x", .y_label = "y", .y_min = 0.0, .y_max = 2.0};
  const std::vector<double> x{0, 1, 2}, y{1, 1, 1};
  panel.curves = {{.x = x, .y = y, .title = "below", .ink = Ink::blue, .width = 2.0},
                  {.x = x, .y = y, .title = "above", .ink = Ink::vermilion, .width = 4.0}};
  picture.plot = {.name = "two", .title = "Two curves", .panels = {panel}};
  page::Table table;
  table.head = {"figure", "paper", "agreement", "Ballast", "taken as", "judged by"};
  const std::string found = "exponent 0.863 [0.836, 0.890] (R² 0.9956, 22 points), χ²/dof 4.0";
  table.rows = {{"Fig. 11, Eq. 3", "one line through all the series that were varied", "partly",
                 found, "0.495 … 0.505", found + "; the law misses the points"}};
  page::Page page{.title = "Wide"};
  page.answers = {.are_given = true, .with_curves = true};
  page.add({"table", "Table", {table}});
  page.add({"figure", "Figure", {picture}});
  return page;
}

}  // namespace

TEST_CASE("later curves stand above earlier ones, and no column is cut where there is room") {
  if (Browser::is_missing() || !page::can_answer() || gnuplot_version().empty()) return;
  const TemporaryFolder folder;
  page::Page page = wide_page();
  page::draw_pictures(page, folder.path(), {.with_pdf = false});
  write_whole_file(folder.path() / "page.html", html_of(page));
  Browser browser(1400, 900);
  browser.open(folder.path() / "page.html", "", "document.querySelector('#two canvas')");
  CHECK(browser.js("(() => { const c = Chart.getChart(document.querySelector('#two canvas')), "
                   "{ x, y } = c.scales; return [...c.ctx.getImageData(x.getPixelForValue(0.5), "
                   "y.getPixelForValue(1), 1, 1).data]; })()") == Json{0xd5, 0x5e, 0x00, 0xff});
  CHECK(browser.js("(() => { const s = document.querySelector('.scroll'); return s.scrollWidth <= "
                   "s.clientWidth; })()") == true);
  CHECK(browser.complaints == std::vector<std::string>{});
}

}  // namespace ballast
