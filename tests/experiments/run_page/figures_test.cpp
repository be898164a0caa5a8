#include "experiments/run_page/figures.hpp"

#include <algorithm>

#include "tests/catch.hpp"
#include "tests/experiments/run_page/box_run.hpp"

namespace ballast {
namespace {

TEST_CASE("lines are thinned, forces have a readable unit") {
  std::vector<double> x(10000), y(10000, 1.0);
  for (size_t k = 0; k < x.size(); ++k) x[k] = static_cast<double>(k);
  y[1234] = 9.0;
  const Curve curve = line_of(x, y, "a", Ink::blue);
  CHECK(curve.x.size() <= 3000);
  CHECK(*std::max_element(curve.y.begin(), curve.y.end()) == 9.0);
  CHECK(std::string(force_unit(999.0).name) == "N");
  CHECK(force_unit(1000.0).factor == 1e-3);
}

TEST_CASE("a figure of a run has its title among the words, and its panel the run's time") {
  const BoxRun box = box_run();
  Panel panel = time_panel(box.data, "x", true);
  CHECK(panel.x_max == box.data.steps.back().time);
  CHECK(panel.log_y);
  panel.curves = {column_line(box.data, &StepRecord::load, 2.0, "", Ink::blue, 1.0)};
  CHECK(*std::max_element(panel.curves[0].y.begin(), panel.curves[0].y.end()) ==
        Approx(2.0 * box.summary.facts.f_max).epsilon(1e-3));
  const page::Picture picture = run_picture("fig03", 300, {panel}, "words");
  CHECK(picture.plot.name == "fig03");
  CHECK_THAT(picture.plot.title, Catch::Matchers::StartsWith("Displacement of the driven wall"));
  CHECK(picture.caption == std::vector<page::Text>{"words"});
}

}  // namespace
}  // namespace ballast
