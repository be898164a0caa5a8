// What is chosen in a replay stands in the page's address.

#include <cstdlib>

#include "tests/browser/driven_box.hpp"

namespace ballast {

TEST_CASE("what is chosen stands in the address, and shows the same again") {
  if (Browser::is_missing()) return;
  const DrivenBox box;
  Browser browser(900, 700);
  browser.open(box.page(), "play=0&rest=0", is_ready);
  const Browser::Json first = picture(browser);
  browser.js(chosen("colour", "rotation", "change"));
  browser.js(clicked("chains"));
  browser.js(chosen("threshold", "2", "input"));
  browser.js(chosen("cut", "y", "change"));
  browser.js(chosen("cutat", "0.3", "input"));
  browser.js(chosen("time", "0.011", "input"));
  browser.js(clicked("view-x"));
  browser.js(
      "ballastReplay.camera.turn(12, 3); ballastReplay.camera.pan(0.1, 0.05); "
      "ballastReplay.camera.zoom(0.8); ballastReplay.touched()");
  // the camera stands in the address with five digits: not to the pixel the same
  const auto looks = [&] {
    return browser.js("Array.from(ballastReplay.pixels().bytes.filter((v, k) => k % 397 === 0))");
  };
  CHECK(picture(browser) != first);
  const Browser::Json seen = looks();
  browser.wait_for("location.hash.includes('t=0.011') && location.hash.includes('at=')");
  const std::string hash = browser.js("location.hash.slice(1)");
  CHECK_THAT(hash, Catch::Contains("colour=rotation") && Catch::Contains("chains=1") &&
                       Catch::Contains("threshold=2") && Catch::Contains("cut=y%3A0.3") &&
                       Catch::Contains("rest=0"));
  browser.open(box.page(), hash, is_ready);
  const Browser::Json again = looks();
  REQUIRE(again.size() == seen.size());
  int others = 0;
  for (size_t k = 0; k < seen.size(); ++k)
    others += std::abs(seen[k].get<int>() - again[k].get<int>()) > 20;
  CHECK(others < static_cast<int>(seen.size()) / 50);
  CHECK(browser.js("['colour', 'threshold', 'cut', 'cutat', 'grains'].map((id) => "
                   "document.getElementById('replay-' + id).value)") ==
        Browser::Json{"rotation", "2", "y", "0.3", "ghost"});
  CHECK(browser.js("document.getElementById('replay-chains').checked") == true);
  CHECK(browser.js("document.getElementById('replay-clock').textContent") == "0.011 s");
  // another address in the same page
  browser.js("location.hash = 'play=0&rest=0&view=y'");
  browser.wait_for("ballastReplay.options.colour === 'speed'");
  CHECK(browser.js("ballastReplay.camera.name()") == "y");
  CHECK(browser.js("ballastReplay.options.chains") == false);
  // a view along an axis is named; what is as at first is left out
  browser.js(clicked("viewz"));
  browser.wait_for("location.hash.includes('view=z')");
  CHECK(browser.js("location.hash.slice(1).split('&').sort()") ==
        Browser::Json{"play=0", "rest=0", "view=z"});
  CHECK(browser.complaints == std::vector<std::string>{});
}

}  // namespace ballast
