// Packings of growing size, each measured in its own process.

#include "experiments/bench/scaling_bench.hpp"

#include <algorithm>
#include <cmath>

#include "tests/catch.hpp"
#include "tests/experiments/bench/tiny_box.hpp"

using namespace ballast;

TEST_CASE("Scaling measures each packing in its own process") {
  CHECK(tiles_for(1000, 1200) == std::pair(1, 1));
  CHECK(tiles_for(10000, 1200) == std::pair(3, 3));
  CHECK(tiles_for(100000, 1200) == std::pair(9, 9));
  ScalingOptions options;
  options.grains = {12, 48};
  options.warm_up = options.steps = options.sweeps = 2;
  options.solvers = {"pgs"};
  options.max_iterations = 50;
  int heard = 0;
  const auto points = measure_scaling(tiny_box(), options, [&](const ScalingPoint&) { ++heard; });
  REQUIRE(points.size() == 2);
  CHECK(heard == 2);
  CHECK(points[0].grains == 12.0);
  CHECK(points[1].grains == 48.0);
  CHECK(points[1].value("contacts") > 2.0 * points[0].value("contacts"));
  for (const ScalingPoint& p : points) {
    CHECK(p.measured[0].group ==
          (p.grains == 12.0 ? "1 thread, 12 grains" : "1 thread, 48 grains"));
    CHECK(p.value("sweep") > 0.0);
    CHECK(p.value("step") >= p.value("detect"));
    CHECK(p.value("iterations needed, pgs") <= 50.0);
    CHECK(p.value("time to the tolerance, pgs") > 0.0);
  }
  CHECK(scaling_figure(options, points).panels[0].curves[0].x == std::vector<double>{12.0, 48.0});
  options.grains = {12};
  options.tolerance = 1e-12;  // one sweep does not do
  options.max_iterations = 1;
  const auto missed = measure_scaling(tiny_box(), options, [](const ScalingPoint&) {});
  CHECK(std::isnan(missed[0].value("iterations needed, pgs")));
  CHECK(missed[0].value("time, tolerance not reached, pgs") > 0.0);
  CHECK(scaling_figure(options, missed).panels[1].curves[0].x.empty());
}
