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
  CHECK(points[1].contacts > 2.0 * points[0].contacts);
  for (const ScalingPoint& p : points) {
    CHECK(p.sweep > 0.0);
    CHECK(p.step >= p.detect);
    REQUIRE(p.iterations.size() == 1);
    CHECK((p.iterations[0] <= 50.0 || std::isinf(p.iterations[0])));
    REQUIRE(p.seconds.size() == 1);
    CHECK(p.seconds[0] > 0.0);
  }
  CHECK(scaling_figure(options, points).panels[0].curves[0].x == std::vector<double>{12.0, 48.0});
  options.grains = {12};
  options.cold_start = true;
  options.max_iterations = 1;  // from nothing, one sweep does not do
  const auto cold = measure_scaling(tiny_box(), options, [](const ScalingPoint&) {});
  CHECK(std::isinf(cold[0].iterations[0]));
  CHECK(scaling_figure(options, cold).panels[1].curves[0].x.empty());
  const auto words = scaling_measurements(options, cold);
  CHECK(std::any_of(words.begin(), words.end(), [](const Measurement& m) {
    return m.name == "time, tolerance not reached, pgs";
  }));
}
