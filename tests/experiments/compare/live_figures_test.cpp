// Lines of trajectories: which figures there are, and what their lines hold.

#include "experiments/compare/live_figures.hpp"

#include "tests/catch.hpp"
#include "tests/experiments/compare/hand_made_live.hpp"

using namespace ballast;

namespace {

const page::Picture* find_figure(const std::vector<page::Picture>& figures,
                                 const std::string& name) {
  for (const page::Picture& figure : figures)
    if (figure.plot.name == name && !figure.plot.panels.empty()) return &figure;
  return nullptr;
}

}  // namespace

TEST_CASE("Every trajectory with something to show is a line") {
  const auto figures = live_figures(hand_made_live());
  const page::Picture* wall = find_figure(figures, "live_wall");
  REQUIRE(wall);
  const std::vector<Curve>& curves = wall->plot.panels[0].curves;
  REQUIRE(curves.size() == 2);  // the third made no step
  CHECK(curves[0].title == "pgs 0.1");
  CHECK(curves[0].y == std::vector<double>{1.0, 2.0});  // mm
  CHECK(curves[1].ink != curves[0].ink);
  CHECK(curves[1].fineness < curves[0].fineness);  // tighter
  CHECK(curves[0].opacity == 1.0);
  const page::Picture* cost = find_figure(figures, "live_cost");
  REQUIRE(cost);
  CHECK(cost->plot.panels[0].curves[0].y[1] == Approx(3e-3));  // summed up
}

TEST_CASE("Distances and deviations are the others' from the reference") {
  const auto figures = live_figures(hand_made_live());
  for (const char* name : {"live_distance", "live_wall_deviation"}) {
    INFO(name);
    const page::Picture* figure = find_figure(figures, name);
    REQUIRE(figure);
    REQUIRE(figure->plot.panels[0].curves.size() == 1);
    const Curve& curve = figure->plot.panels[0].curves[0];
    CHECK(curve.title == "nncg 0.015");
    for (const double y : curve.y) CHECK(y == Approx(3.0));  // µm
  }
  CHECK(page::plain_words(find_figure(figures, "live_distance")->caption.at(0)).find("(pgs 0.1)") !=
        std::string::npos);
}

TEST_CASE("Without wall and reference there are no figures of them") {
  LiveComparison live = hand_made_live();
  live.has_driven_wall = false;
  live.reference = -1;
  const auto figures = live_figures(live);
  for (const char* name : {"live_wall", "live_wall_deviation", "live_force", "live_distance"})
    CHECK(find_figure(figures, name) == nullptr);
  CHECK(find_figure(figures, "live_error") != nullptr);
}
