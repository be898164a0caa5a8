// The page of a comparison in a real browser: the tests ask as a reader does and check the page.

#include "experiments/compare/compare_page.hpp"
#include "experiments/run/run_folder.hpp"
#include "platform/atomic_file.hpp"
#include "platform/text.hpp"
#include "tests/experiments/compare/hand_made_row.hpp"
#include "tests/support/browser.hpp"

namespace ballast {
namespace {

namespace fs = std::filesystem;
using Json = Browser::Json;
using Catch::Matchers::Contains;

constexpr const char* is_drawn = "document.querySelectorAll('.live canvas').length > 3";

/// Three cases of two families; b is twice as fast as a on y and z, c does not solve z.
struct HandMadeComparison {
  HandMadeComparison() {
    for (const double tolerance : {1e-4, 1e-6})
      for (const char* name : {"x1", "y2", "z3"})
        for (const char* solver : {"a", "b", "c"}) add(name, solver, tolerance);
    Manifest("compare", {"ballast compare"}, "key").write(place.path() / "manifest.json");
    write_compare_page(place.path(), rows);
  }
  void add(const char* name, const char* solver, double tolerance) {
    const bool is_b = solver[0] == 'b' && name[0] != 'x';
    const bool fails = solver[0] == 'c' && name[0] == 'z';
    const double seconds = fails ? 60.0 : (is_b ? 0.2 : 0.4) + (solver[0] == 'c' ? 0.3 : 0.0);
    CompareRow row =
        hand_made_row(name, solver, seconds, fails ? Verdict::timeout : Verdict::solved);
    row.tolerance = tolerance;
    row.family = name[0] == 'x' ? "small, first" : "large";
    row.facts.contacts = name[0] == 'x' ? 10 : name[0] == 'y' ? 20 : 300;
    row.word = std::string("folder/") + name + ".dat";
    row.key = std::string(name) + solver + (tolerance > 1e-5 ? "4" : "6");
    row.can_view = name[0] != 'z';
    rows.push_back(row);
  }
  fs::path page() const { return place.path() / "compare.html"; }

  const TemporaryFolder place;
  std::vector<CompareRow> rows;
};
/// The comparison that all tests of a process share.
const HandMadeComparison& hand_made() {
  static const HandMadeComparison made;
  return made;
}

/// True without a browser or without the library that draws charts (html_test has that case).
bool is_missing() { return Browser::is_missing() || !page::has_chart_library(); }

/// The cells of the table's body as text, rows separated by "|".
Json cells(Browser& browser, const std::string& table) {
  return browser.js("[...document.querySelectorAll('" + table +
                    " tbody tr')].map((r) => [...r.cells].map((c) => c.textContent.trim()).join("
                    "' ')).join('|')");
}

std::string pressed(const std::string& selector) {
  return "document.querySelector(`" + selector + "`).click()";
}

/// Scrolls the chart into the window. Returns where the point lies in the window.
Json place_of(Browser& browser, const std::string& canvas, int curve, int point) {
  return browser.js(
      printed("(() => { const c = document.querySelector('%s'); c.scrollIntoView({"
              "block: 'center'}); const p = Chart.getChart(c).getDatasetMeta(%d)."
              "data[%d], b = c.getBoundingClientRect(); return [b.left + p.x, "
              "b.top + p.y]; })()",
              canvas.c_str(), curve, point));
}

}  // namespace

TEST_CASE("tables in the browser are what the program computed, sort, and follow the choice") {
  if (is_missing()) return;
  const HandMadeComparison& made = hand_made();
  Browser browser(1400, 900);
  browser.open(made.page(), "", is_drawn);
  // The program wrote the same table into the page, for readers without scripts.
  const Json live = cells(browser, "#backends .live");
  CHECK(live == browser.js("[...document.querySelector('#backends > .scroll').querySelectorAll("
                           "'tbody tr')].map((r) => [...r.cells].map((c) => c.textContent.trim())"
                           ".join(' ')).join('|')"));
  CHECK_THAT(live.get<std::string>(), Catch::StartsWith("b coulomb 3 of 3 "));
  // Sorts by the backend's name, then backwards.
  browser.js(pressed("#backends .live th button"));
  CHECK_THAT(cells(browser, "#backends .live").get<std::string>(), Catch::StartsWith("a "));
  browser.js(pressed("#backends .live th button"));
  CHECK_THAT(cells(browser, "#backends .live").get<std::string>(), Catch::StartsWith("c "));
  // Without the large problems every backend solves all; the order by name stays.
  browser.js(pressed("[name=without_family][value=large]"));
  CHECK_THAT(cells(browser, "#backends .live").get<std::string>(),
             Catch::StartsWith("c coulomb 1 of 1"));
  // The address keeps the order too. Columns without information are hidden.
  const std::string kept = browser.js("location.hash.slice(1)");
  CHECK(browser.js("[...document.querySelectorAll('#backends .live th')].some((h) => h.hidden && "
                   "h.textContent === 'crashes')") == true);
  browser.open(made.page(), kept, is_drawn);
  CHECK_THAT(cells(browser, "#backends .live").get<std::string>(),
             Catch::StartsWith("c coulomb 1 of 1"));
  browser.js(pressed("[name=without_family][value=large]"));
  // Filters by size, and by words of the name.
  browser.open(made.page(), "from=15&to=100", is_drawn);
  CHECK(browser.js("document.querySelectorAll('#matrix .live tbody tr').length") == 1);
  browser.open(made.page(), "find=Z3&tolerance=1e-06", is_drawn);
  CHECK_THAT(cells(browser, "#matrix .live").get<std::string>(),
             Catch::StartsWith("z3 300 ") && Contains("killed"));
}

TEST_CASE("profiles are computed for the chosen backends and cases") {
  if (is_missing()) return;
  const HandMadeComparison& made = hand_made();
  Browser browser(1400, 900);
  browser.open(made.page(), "", is_drawn);
  const std::string curve =
      "JSON.stringify(Chart.getChart(document.querySelector('#profiles canvas')).data.datasets"
      ".map((d) => [d.label, ...d.data.slice(1, -1).map((p) => [+p.x.toFixed(3), "
      "+p.y.toFixed(3)])]))";
  // a is as fast as the fastest on x, half as fast on y and z.
  CHECK(Json::parse(browser.js(curve).get<std::string>())[0] ==
        Json::parse(R"(["a", [1, 0.333], [2, 0.667], [2, 1]])"));
  browser.js(pressed("[name=without][value=b]"));
  CHECK(Json::parse(browser.js(curve).get<std::string>()) ==
        Json::parse(
            R"([["a", [1, 0.333], [1, 0.667], [1, 1]], ["c", [1.75, 0.333], [1.75, 0.667]]])"));
  // The address keeps the choice.
  const std::string kept = browser.js("location.hash.slice(1)");
  CHECK(kept == "without=b");
  browser.open(made.page(), kept, is_drawn);
  CHECK(Json::parse(browser.js(curve).get<std::string>()).size() == 2);
}

TEST_CASE("a point tells its values, and a click opens its solve with the command") {
  if (is_missing()) return;
  const HandMadeComparison& made = hand_made();
  Browser browser(1400, 900);
  browser.open(made.page(), "", is_drawn);
  const Json spot = place_of(browser, "#cost canvas", 1, 2);  // b on z3
  browser.js(
      printed("document.querySelector('#cost canvas').dispatchEvent(new MouseEvent("
              "'mousemove', {clientX: %.2f, clientY: %.2f, bubbles: true}))",
              spot[0].get<double>(), spot[1].get<double>()));
  browser.wait_for("document.querySelector('#cost .said').textContent.startsWith('b; ')");
  CHECK_THAT(browser.js("document.querySelector('#cost .said').textContent").get<std::string>(),
             Contains("contacts 300") && Contains("z3") && Contains("200"));
  browser.click(spot[0], spot[1]);
  browser.wait_for("document.querySelector('dialog').open");
  CHECK(browser.js("location.hash") == "#row=z3b4");
  CHECK(browser.js("document.querySelector('dialog pre').textContent") ==
        "ballast compare folder/z3.dat --solvers b --tolerances 0.0001 --starts cold --measure "
        "natural_map --max-seconds 60 --output results/again");
  CHECK(browser.js("document.querySelectorAll('dialog canvas').length") == 1);
  browser.key("Escape");
  CHECK(browser.js("document.querySelector('dialog').open") == false);
  // With the keyboard alone: selects the third point of the first curve, then the next curve.
  browser.js("document.querySelector('#cost canvas').focus()");
  for (const char* key : {"ArrowRight", "ArrowRight", "ArrowDown", "Enter"}) browser.key(key);
  CHECK(browser.js("location.hash") == "#row=y2b4");
}

TEST_CASE("a solve says where in the packing it is wrong: by a command, or not at all") {
  if (is_missing()) return;
  const HandMadeComparison& made = hand_made();
  Browser browser(1400, 900);
  const std::string commands =
      "[...document.querySelectorAll('dialog pre')].slice(1).map((e) => e.textContent).join('|')";
  browser.open(made.page(), "row=y2b4", "document.querySelector('dialog[open]')");
  CHECK(browser.js(commands) == "ballast view folder/y2.dat --solver b --solver auto");
  browser.open(made.page(), "row=z3b4", "document.querySelector('dialog[open]')");
  CHECK(browser.js(commands) == "");
  CHECK_THAT(browser.js("document.querySelector('dialog').textContent").get<std::string>(),
             Contains("does not say where its contacts are"));
}

TEST_CASE("legends switch a curve off everywhere, and the rows are saved as they are in the CSV") {
  if (is_missing()) return;
  const HandMadeComparison& made = hand_made();
  Browser browser(1400, 900);
  browser.open(made.page(), "", is_drawn);
  browser.js(pressed("#profiles [data-title=a]"));
  CHECK(browser.js("document.querySelector('#cost [data-title=a]').getAttribute('aria-pressed')") ==
        "false");
  CHECK(browser.js("[...document.querySelectorAll('.live canvas')].some((c) => { const h = "
                   "Chart.getChart(c); return h.data.datasets.some((d, k) => d.label === 'a' && "
                   "h.isDatasetVisible(k)); })") == false);
  // A hidden curve stays among those that the others are measured against.
  CHECK_THAT(cells(browser, "#backends .live").get<std::string>(), Contains("a coulomb 3 of 3"));
  browser.js(
      "URL.createObjectURL = (blob) => { window.saved = blob; return '#' + "
      "location.hash.slice(1); }");
  browser.js(
      "[...document.querySelectorAll('#asks button')].find((b) => b.textContent === "
      "'all rows as CSV').click()");
  CHECK(browser.js("window.saved.text()") == compare_csv(made.rows));
}

TEST_CASE("light, dark, wide and narrow: charts have ink, and no page is wider than its window") {
  if (is_missing()) return;
  const HandMadeComparison& made = hand_made();
  Browser browser(375, 900);
  std::vector<Json> grounds;
  for (const bool is_dark : {false, true})
    for (const int width : {375, 1400}) {
      INFO(width << (is_dark ? " dark" : " light"));
      browser.look(width, 900, is_dark);
      browser.open(made.page(), "row=x1a4", is_drawn);
      CHECK(browser.js("document.documentElement.scrollWidth <= innerWidth") == true);
      CHECK(
          browser.js("[...document.querySelectorAll('.live canvas')].every((c) => { const b = "
                     "c.getContext('2d').getImageData(0, 0, c.width, c.height).data; let n = 0; "
                     "for (let k = 3; k < b.length; k += 4) n += b[k] > 0; return n > 1000; })") ==
          true);
      grounds.push_back(browser.js("getComputedStyle(document.body).backgroundColor"));
    }
  CHECK(grounds[0] == grounds[1]);
  CHECK(grounds[0] != grounds[2]);
}

}  // namespace ballast
