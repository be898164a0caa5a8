// The page of a closed loop in a real browser: charts replace the drawn figures.

#include "experiments/compare/live.hpp"
#include "experiments/run/run_folder.hpp"
#include "tests/experiments/compare/hand_made_live.hpp"
#include "tests/support/browser.hpp"

namespace ballast {

TEST_CASE("every figure of a closed loop tells its values and has a legend that switches") {
  if (Browser::is_missing() || !page::has_chart_library() || gnuplot_version().empty()) return;
  const TemporaryFolder folder;
  Manifest("compare --live x", {}, "key").write(folder.path() / "manifest.json");
  LiveComparison live = hand_made_live();
  live.command = "ballast compare --live x";
  write_live_page(folder.path(), live);
  Browser browser(1400, 900);
  browser.open(folder.path() / "live.html", "", "document.querySelector('.chart canvas')");
  // The drawn figures stay in the page for print.
  CHECK(browser.js("document.querySelectorAll('figure svg').length") ==
        browser.js("document.querySelectorAll('figure canvas').length"));
  CHECK(browser.js("[...document.querySelectorAll('figure svg')].every((s) => "
                   "getComputedStyle(s).display === 'none')") == true);
  // Ticks are at round numbers, not at the ends of the curves.
  CHECK(browser.js("Object.values(Chart.instances).filter((c) => c.scales.x.type === 'linear')"
                   ".every((c) => { const t = c.scales.x.ticks, s = t[1].value - t[0].value; "
                   "return t.every((one) => Math.abs(one.value / s - Math.round(one.value / s)) < "
                   "1e-6); })") == true);
  // Selects the second point of the second trajectory with the keyboard.
  browser.js("document.querySelector('#live_wall canvas').focus()");
  for (const char* key : {"ArrowRight", "ArrowRight", "ArrowDown"}) browser.key(key);
  CHECK(browser.js("document.querySelector('#live_wall .said').textContent") ==
        "nncg 0.015; t 0.002\u202fs; wall x 2.003\u202fmm");
  browser.js("document.querySelector('#live_wall [data-title=\"pgs 0.1\"]').click()");
  CHECK(browser.js("['live_wall', 'live_error'].map((n) => Chart.getChart(document.querySelector("
                   "'#' + n + ' canvas')).isDatasetVisible(0))") == Browser::Json{false, false});
  // All fourteen columns are visible.
  CHECK(browser.js("(() => { const t = document.querySelector('.scroll'); return t.scrollWidth <= "
                   "t.clientWidth; })()") == true);
  CHECK(browser.js("document.documentElement.scrollWidth <= innerWidth") == true);
}

}  // namespace ballast
