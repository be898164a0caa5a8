// The page of a run in a real browser: acts as a reader does and checks the page and its picture.

#include <algorithm>
#include <cmath>
#include <set>

#include "experiments/record/record_file.hpp"
#include "experiments/view/view.hpp"
#include "platform/text.hpp"
#include "tests/browser/driven_box.hpp"
#include "tests/support/captured_run.hpp"
#include "tests/support/temporary_folder.hpp"

namespace ballast {
namespace {

namespace fs = std::filesystem;
using Json = Browser::Json;
using Catch::Matchers::Contains;

/// The share of the picture's pixels for which `test` (an expression of r, g, b: 0 to 255) holds,
/// and the first and last column with such pixels.
Json pixels(Browser& browser, const std::string& test) {
  return browser.js("(() => { const { width, height, bytes } = " + pixels_of() + R"(;
    let count = 0, first = width, last = -1;
    for (let k = 0; k < bytes.length; k += 4) {
      const r = bytes[k], g = bytes[k + 1], b = bytes[k + 2];
      if (!()" + test +
                    R"()) continue;
      const x = (k / 4) % width;
      ++count;
      first = Math.min(first, x);
      last = Math.max(last, x);
    }
    return { share: count / (width * height), first, last, width, height };
  })())");
}

}  // namespace

TEST_CASE("a run's page plays, steps and scrubs, and a click in a plot goes to that moment") {
  if (Browser::is_missing()) return;
  const DrivenBox& box = driven_box();
  Browser browser(900, 700);
  browser.open(box.page(), "play=0", is_ready);
  REQUIRE(browser.js("window.ballastReplayError || ''") == "");
  REQUIRE(browser.js("ballastReplay.data.times.length") == box.frames.size());
  const auto time = [&] { return browser.js("ballastReplay.time").get<double>(); };
  // The poses that the page unpacks are those of the record.
  for (const size_t f : {size_t{0}, box.frames.size() - 1}) {
    const Json state =
        browser.js(printed("(ballastReplay.data.moveTo(%.17g, () => 0), "
                           "Array.from(ballastReplay.data.state.subarray(0, 8 * 60)))",
                           box.frames[f].time));
    double place = 0.0, turn = 0.0;
    for (size_t g = 0; g < 60; ++g) {
      const Pose& pose = box.frames[f].pose[g];
      const auto at = [&](size_t k) { return state[8 * g + k].get<double>(); };
      place = std::max(place, (Vec3(at(0), at(1), at(2)) - pose.position).norm());
      turn = std::max(turn, Quat(at(4), at(5), at(6), at(7)).angularDistance(pose.rotation));
    }
    CHECK(place < 1e-5);
    CHECK(turn < 2e-4);
  }
  const Json before = picture(browser);
  browser.js(clicked("on"));
  CHECK(std::abs(time() - box.frames[1].time) < 1e-9);
  CHECK(picture(browser) != before);
  browser.js(chosen("time", "0.011", "input"));
  CHECK(std::abs(time() - 0.011) < 1e-6);
  browser.js(clicked("back"));
  CHECK(std::abs(time() - 0.010) < 1e-9);
  // With the keyboard: the picture has the focus.
  browser.js("document.getElementById('replay-canvas').focus()");
  browser.js("ballastReplay.rate = 0.01");
  browser.key(" ", " ");
  CHECK(browser.js("ballastReplay.playing") == true);
  browser.wait_for("ballastReplay.time > 0.0103");
  browser.key(" ", " ");
  CHECK(browser.js("ballastReplay.playing") == false);
  browser.key(".", ".");
  CHECK(std::abs(std::remainder(time(), 0.002)) < 1e-9);
  // A click on the middle of the first plot goes to the middle of the run.
  browser.js("document.getElementById('replay-plots').scrollIntoView()");
  const Json spot = browser.js(
      "(() => { const p = ballastReplay.plots.panels[0], b = p.picture.getBoundingClientRect(); "
      "return [b.left + (p.x(p.left) + p.x(p.right)) / 2, b.top + b.height / 2]; })()");
  browser.click(spot[0], spot[1]);
  CHECK(std::abs(time() - 0.01) < 2e-4);
}

TEST_CASE("the driven wall stands where steps.csv says, within a pixel's worth") {
  if (Browser::is_missing()) return;
  const DrivenBox& box = driven_box();
  Browser browser(900, 700);
  browser.open(box.page(), "play=0&view=y&grains=hidden", is_ready);
  std::set<int> columns;
  for (const size_t k : {size_t{9}, box.steps.size() - 1}) {
    const StepRecord& step = box.steps[k];
    browser.js(printed("ballastReplay.setTime(%.17g)", step.time));
    // Only the wall is blue. Seen from the side it is a line between its near and its far edge.
    const Json blue = pixels(browser, "b > r + 60 && b > g + 20");
    const double x = 0.2 + step.wall_x;
    const Json edges = browser.js(
        printed("(() => { const s = ballastReplay.stages[0], d = ballastReplay.data, "
                "m = ballastReplay.camera.matrix(s.aspect); return [d.low[1], d.high[1]].map("
                "(y) => s.canvas.width * ballastReplay.projected(m, [%.17g, y, 0.1])[0]).sort("
                "(a, b) => a - b); })()",
                x));
    INFO("step " << k << ": " << blue.dump() << " " << edges.dump());
    CHECK(std::abs(blue["first"].get<double>() + 0.5 - edges[0].get<double>()) < 2.5);
    CHECK(std::abs(blue["last"].get<double>() + 0.5 - edges[1].get<double>()) < 2.5);
    columns.insert(blue["last"].get<int>());
  }
  CHECK(columns.size() == 2);  // the wall has moved by a column or more
}

TEST_CASE("colour, cut, chains and a picked grain change what is seen and said") {
  if (Browser::is_missing()) return;
  const DrivenBox& box = driven_box();
  Browser browser(900, 700);
  browser.open(box.page(), "play=0&t=0.02", is_ready);
  const Json whole = pixels(browser, "Math.max(r, g, b) - Math.min(r, g, b) > 40");
  CHECK(whole["share"] > 0.05);
  Json last = picture(browser);
  for (const char* colour : {"displacement", "rotation", "force", "size", "none"}) {
    INFO(colour);
    browser.js(chosen("colour", colour, "change"));
    CHECK(browser.js("ballastReplay.options.colour") == colour);
    const Json now = picture(browser);
    CHECK(now != last);
    last = now;
  }
  browser.js(chosen("colour", "displacement", "change"));
  browser.js(chosen("cut", "y", "change"));
  CHECK(pixels(browser, "Math.max(r, g, b) - Math.min(r, g, b) > 40")["share"] != whole["share"]);
  browser.js(chosen("cut", "", "change"));
  // Every pair of bodies that push on each other is one chain.
  std::set<std::pair<int, int>> pairs;
  const RecordForces forces(box.folder / "record.h5");
  for (const FrameContact& contact : forces.of_frame(forces.frame_count() - 1))
    pairs.emplace(contact.body_a, contact.body_b);
  browser.js(clicked("chains"));
  browser.js(chosen("threshold", "0", "input"));
  picture(browser);
  CHECK(browser.js("ballastReplay.marks.shownChains") == pairs.size());
  CHECK_THAT(browser.js("document.getElementById('replay-legend').innerText").get<std::string>(),
             Contains("displacement since the start / mm") && Contains("force of a pair / N"));
  CHECK(browser.js("document.getElementById('replay-thresholdtext').textContent") == "0.0 × mean");
  CHECK(browser.js("ballastReplay.options.grains") == "ghost");
  browser.js(chosen("threshold", "2", "input"));
  picture(browser);
  CHECK(browser.js("ballastReplay.marks.shownChains") < pairs.size() / 2);
  browser.js(clicked("chains"));
  // Clicks on the grain that is nearest to the eye.
  browser.js("document.getElementById('replay').scrollIntoView()");
  const Json spot = browser.js(
      "(() => { const d = ballastReplay.data, s = ballastReplay.stages[0], e = "
      "ballastReplay.camera.eye; let best = 0, least = Infinity; for (let g = 0; g < d.grains; "
      "++g) { const p = d.state.subarray(8 * g, 8 * g + 3), away = Math.hypot(p[0] - e[0], "
      "p[1] - e[1], p[2] - e[2]); if (away < least) [best, least] = [g, away]; } const at = "
      "ballastReplay.projected(ballastReplay.camera.matrix(s.aspect), "
      "d.state.subarray(8 * best, 8 * best + 3)), b = s.canvas.getBoundingClientRect(); return "
      "[best, b.left + at[0] * b.width, b.top + at[1] * b.height]; })()");
  browser.click(spot[1], spot[2]);
  CHECK(browser.js("ballastReplay.options.picked") == spot[0]);
  picture(browser);
  const std::string facts = browser.js("document.getElementById('replay-facts').innerText");
  CHECK_THAT(facts, Contains("grain " + spot[0].dump()) && Contains("mass") &&
                        Contains("velocity") && Contains("touches"));
}

TEST_CASE("two backends' errors stand side by side, and the worst contact is found") {
  if (Browser::is_missing()) return;
  const TemporaryFolder place;
  const fs::path file = captured_run(place.path() / "run");
  const ViewData view =
      view_of_problem(file, {.backends = {"pgs", "auto"}, .most_iterations = 100});
  write_view_page(view, place.path() / "errors.html");
  Browser browser(900, 700);
  browser.open(place.path() / "errors.html", "", is_ready);
  REQUIRE(browser.js("window.ballastReplayError || ''") == "");
  REQUIRE(browser.js("ballastReplay.stages.length") == 2);
  for (const int budget : {0, 2})
    for (const size_t solve : {size_t{0}, size_t{1}}) {
      browser.js(chosen("budget", std::to_string(budget), "input"));
      const std::vector<double>& error = view.errors[solve].error[static_cast<size_t>(budget)];
      const Json said = browser.js(
          printed("Array.from({ length: %zu }, (_, c) => ballastReplay.errors.errorOf(%zu, c))",
                  error.size(), solve));
      for (size_t c = 0; c < error.size(); ++c)
        CHECK(std::abs(said[c].get<double>() - std::clamp(std::log10(error[c]), -9.0, 2.0)) < 0.03);
    }
  browser.js(clicked("worst"));
  const int worst = browser.js("ballastReplay.errors.worst");
  const std::vector<double>& last = view.errors[0].error[2];
  CHECK(last[static_cast<size_t>(worst)] > 0.9 * *std::max_element(last.begin(), last.end()));
  const Json sharp =
      browser.js("ballastReplay.stages.map((s) => new Set(" + pixels_of("s") + ".bytes).size)");
  CHECK((sharp[0] > 20 && sharp[1] > 20));
  // an address holds what is not as at first: both pictures show the second backend
  browser.open(place.path() / "errors.html", "left=auto", is_ready);
  CHECK(browser.js("ballastReplay.errors.shown") == Json{1, 1});
  browser.js("location.hash = 'play=0'; new Promise((go) => setTimeout(go, 500))");
  CHECK(browser.js("ballastReplay.errors.shown") == Json{0, 1});
  browser.open(place.path() / "errors.html", "t=abc&rate=x&picked=x&view=a,b,c,d,e,f&budget=z",
               is_ready);
  CHECK(browser.js("[ballastReplay.time, ballastReplay.rate, ballastReplay.options.picked, "
                   "ballastReplay.camera.distance].every(Number.isFinite)") == true);
}

TEST_CASE("what is most wrong stands out from a light and a dark ground") {
  if (Browser::is_missing()) return;
  const TemporaryFolder place;
  const fs::path file = captured_run(place.path() / "run");
  write_view_page(view_of_problem(file, {.backends = {"pgs"}, .most_iterations = 1}),
                  place.path() / "errors.html");
  Browser browser(900, 700);
  for (const bool is_dark : {false, true}) {
    browser.look(900, 700, is_dark);
    browser.open(place.path() / "errors.html", "", is_ready);
    // Contrast of the largest ball with the background, as the accessibility guidelines define it.
    const double contrast = browser.js(
        "(() => { const { rods, paper } = ballastReplay.look(0), balls = []; for (let k = 0; "
        "k < rods.length; k += 12) balls.push(rods.slice(k, k + 12)); const ball = balls.sort("
        "(a, b) => b[3] - a[3])[0], light = ([r, g, b]) => 0.2126 * r + 0.7152 * g + 0.0722 * b + "
        "0.05, two = [light(ball.slice(8)), light(paper)]; return Math.max(...two) / "
        "Math.min(...two); })()");
    CHECK(contrast > 4.5);
  }
}

TEST_CASE("the shadow is drawn anew where bodies, the cut or glass have changed, not the view") {
  if (Browser::is_missing()) return;
  const DrivenBox& box = driven_box();
  Browser browser(900, 700);
  browser.open(box.page(), "play=0", is_ready);
  const Browser::Json first = picture(browser);
  browser.js(
      "window.drawn = 0; { const s = ballastReplay.stages[0], draw = s.drawNumbers; "
      "s.drawNumbers = function (...all) { ++drawn; return draw.apply(this, all); }; }");
  const auto drawn_after = [&](const std::string& change) {
    browser.js("drawn = 0; " + change + "; ballastReplay.draw(); ballastReplay.draw()");
    return browser.js("drawn").get<int>();
  };
  CHECK(drawn_after("ballastReplay.camera.turn(40, 10)") == 0);
  CHECK(drawn_after("ballastReplay.setTime(0.011)") == 1);
  CHECK(drawn_after("ballastReplay.set({ cut: 'y' })") == 1);
  CHECK(drawn_after("ballastReplay.set({ cut: '', grains: 'ghost' })") == 1);
  // Back in the first state it draws the same picture.
  browser.js(
      "ballastReplay.set({ grains: 'solid' }); ballastReplay.setTime(ballastReplay.data."
      "begin); ballastReplay.camera.home()");
  CHECK(picture(browser) == first);
}

namespace {

ViewData one_tetrahedron(const TemporaryFolder& folder) {
  return view_of_mesh(folder.write("t.obj",
                                   "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\n"
                                   "f 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n"));
}

}  // namespace

TEST_CASE("a body whose number needs more than 16 bits is seen where it is") {
  if (Browser::is_missing()) return;
  const TemporaryFolder folder;
  ViewData view = one_tetrahedron(folder);
  constexpr int count = 150000;  // also more than a call can take as arguments
  MechanicalSystem& system = view.system;
  system.bodies.assign(count, RigidBody(system.bodies[0]));
  system.grain_count = count;
  MotionState& frame = view.frames[0];
  frame.pose.assign(count, Pose{Vec3(60.0, 0.0, 0.0), frame.pose[0].rotation});
  frame.pose.back().position = Vec3::Zero();  // all but the last are at the same place
  frame.velocity.assign(count, Vec3::Zero());
  frame.spin = frame.velocity;
  write_view_page(view, folder.path() / "page.html");
  Browser browser(900, 700);
  browser.open(folder.path() / "page.html", "play=0", is_ready);
  CHECK(browser.js(printed("(() => { const r = ballastReplay, s = r.stages[0], at = r.projected("
                           "r.camera.matrix(s.aspect), r.data.centreOf(%d)); return s.pick("
                           "r.look(0), ...at); })()",
                           count - 1)) == count - 1);
  browser.wait_for("ballastReplay.isDraft === false");  // first draws balls, then all corners
}

TEST_CASE("a body goes on where the world begins anew, and its way counts from the start") {
  if (Browser::is_missing()) return;
  const TemporaryFolder folder;
  ViewData view = one_tetrahedron(folder);
  view.system.period.vector = Vec3(8.0, 6.0, 0.0);
  view.system.bodies.resize(2, RigidBody(view.system.bodies[0]));
  view.system.grain_count = 2;
  // The first body follows the second so closely that they touch, over nine periods.
  const Vec3 velocity(4.0, 1.0, 0.0), gap(0.4, 0.2, 0.0), begin(1.0, 1.0, 2.0);
  const Pose pose = view.frames[0].pose[0];
  view.frames.clear();
  for (int f = 0; f <= 24; ++f) {
    MotionState& frame = view.frames.emplace_back();
    frame.time = frame.step = f;
    frame.pose.assign(2, pose);
    frame.pose[0].position = view.system.period.wrapped(begin + f * velocity);
    frame.pose[1].position = view.system.period.wrapped(begin + f * velocity + gap);
    frame.velocity.assign(2, velocity);
    frame.spin.assign(2, Vec3::Zero());
  }
  const Eigen::Vector3f x = Eigen::Vector3f::UnitX();
  view.contacts = [x](size_t) { return std::vector<FrameContact>{{0, 1, x, x, x}}; };
  write_view_page(view, folder.path() / "page.html");
  Browser browser(900, 700);
  browser.open(folder.path() / "page.html", "play=0", is_ready);
  REQUIRE(browser.js("window.ballastReplayError || ''") == "");
  for (double time = 0.0; time <= 24.0; time += 0.125) {
    INFO(time);
    const Json at = browser.js(
        printed("(({ data, shades, marks }) => { data.moveTo(%.17g, shades.choices.displacement."
                "value); const rods = []; marks.addChains(%.17g, rods, { threshold: 0 }); return "
                "[...data.centreOf(0), data.state[3], ...rods]; })(ballastReplay)",
                time, time));
    const auto vector = [&](size_t k) { return Vec3(at[k], at[k + 1], at[k + 2]); };
    const Vec3 way = time * velocity, place = view.system.period.wrapped(begin + way);
    CHECK((vector(0) - place).norm() < 1e-2);
    CHECK(std::abs(at[3].get<double>() - way.norm()) < 1e-2);
    CHECK((vector(8) - vector(4) - gap).norm() < 1e-2);
  }
}

TEST_CASE("where whole pictures come slowly, grains are balls while something moves") {
  if (Browser::is_missing()) return;
  Browser browser(900, 700);
  browser.open(driven_box().page(), "play=0&colour=none", is_ready);
  const Json whole = picture(browser);
  // Counts pixels that are dark in the draft, in the whole picture, and in both.
  const Json draft = browser.js(R"((() => {
    const r = ballastReplay, { gl, canvas: { width, height } } = r.stages[0];
    const seen = (moving) => {
      const bytes = new Uint8Array(4 * width * height);
      Object.assign(r, { wholeTook: 1000, moving });
      r.draw();
      gl.bindFramebuffer(gl.FRAMEBUFFER, null);
      gl.readPixels(0, 0, width, height, gl.RGBA, gl.UNSIGNED_BYTE, bytes);
      return bytes;
    };
    const count = (test) => Array.from({ length: width * height }, (_, k) => 4 * k).filter(test);
    const balls = seen(true), isDraft = r.isDraft, grains = seen(false);
    const isDark = (bytes) => (k) => bytes[k] + bytes[k + 1] + bytes[k + 2] < 600;
    return { isDraft, stays: r.isDraft, balls: count(isDark(balls)).length,
      grains: count(isDark(grains)).length,
      same: count((k) => isDark(balls)(k) && isDark(grains)(k)).length };
  })())");
  INFO(draft.dump());
  CHECK(draft["isDraft"] == true);
  CHECK(draft["stays"] == false);
  const double grains = draft["grains"], balls = draft["balls"], same = draft["same"];
  CHECK(grains > 10000.0);
  CHECK(std::abs(balls / grains - 1.0) < 0.25);
  CHECK(same > 0.7 * grains);
  CHECK(picture(browser) == whole);
}

TEST_CASE("narrow, dark, and without 3D") {
  if (Browser::is_missing()) return;
  const DrivenBox& box = driven_box();
  {
    Browser browser(375, 800, true);
    browser.open(box.page(), "play=0", is_ready);
    CHECK(browser.js("document.scrollingElement.scrollWidth") == 375);
    // The words of every legend do not overlap, and the load's words lie within the picture.
    for (const char* colour : {"speed", "size", "rotation"}) {
      browser.js(chosen("colour", colour, "change"));
      CHECK(browser.js("(() => { const b = [...document.querySelectorAll('#replay-legend .ticks "
                       "span')].map((s) => s.getBoundingClientRect()); return b.length > 1 && "
                       "b.every((r, k) => !k || r.left > b[k - 1].right); })()") == true);
    }
    browser.js("ballastReplay.setTime(0.01)");
    picture(browser);
    CHECK(browser.js("(() => { const l = document.getElementById('replay-load')."
                     "getBoundingClientRect(), p = document.getElementById('replay-canvas')."
                     "getBoundingClientRect(); return l.width > 20 && l.left >= p.left && "
                     "l.right <= p.right && l.top >= p.top; })()") == true);
    CHECK(pixels(browser, "r < 40 && g < 40 && b < 45")["share"] > 0.3);
    browser.look(1400, 900, false);
    browser.open(box.page(), "play=0", is_ready);
    CHECK(browser.js("document.scrollingElement.scrollWidth") == 1400);
    CHECK(browser.js("document.getElementById('replay').clientWidth").get<int>() > 1200);
  }
  Browser browser(900, 700, false, {"--disable-3d-apis"});
  browser.open(box.page(), "", is_ready);
  CHECK_THAT(browser.js("document.getElementById('replay-sentence').innerText").get<std::string>(),
             Contains("WebGL 2"));
}

TEST_CASE("what is chosen stands in the address, and shows the same again") {
  if (Browser::is_missing()) return;
  const DrivenBox& box = driven_box();
  Browser browser(900, 700);
  browser.open(box.page(), "play=0", is_ready);
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
  // The address keeps the camera to five digits, so that not every pixel is the same.
  const auto looks = [&] {
    return browser.js("Array.from(" + pixels_of() + ".bytes.filter((v, k) => k % 397 === 0))");
  };
  CHECK(picture(browser) != first);
  const Browser::Json seen = looks();
  browser.wait_for("location.hash.includes('t=0.011') && location.hash.includes('view=')");
  const std::string hash = browser.js("location.hash.slice(1)");
  CHECK_THAT(hash, Catch::Contains("colour=rotation") && Catch::Contains("chains=1") &&
                       Catch::Contains("threshold=2") && Catch::Contains("cut=y") &&
                       Catch::Contains("cutAt=0.3"));
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
  // Goes to another address in the same page.
  browser.js("location.hash = 'play=0&view=y'");
  browser.wait_for("ballastReplay.options.colour === 'speed'");
  CHECK(browser.js("ballastReplay.camera.name()") == "y");
  CHECK(browser.js("ballastReplay.options.chains") == false);
  // The address names a view along an axis and leaves out defaults.
  browser.js(clicked("viewz"));
  browser.wait_for("location.hash.includes('view=z')");
  CHECK(browser.js("location.hash.slice(1).split('&').sort()") ==
        Browser::Json{"play=0", "view=z"});
  browser.js("ballastReplay.camera.zoom(0.5); ballastReplay.touched()");
  browser.wait_for("!location.hash.includes('view=z')");  // the name would lose the distance
}

}  // namespace ballast
