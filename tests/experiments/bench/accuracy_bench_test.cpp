// What a simulated second costs at which error.

#include "experiments/bench/accuracy_bench.hpp"

#include "experiments/compare/compare_options.hpp"
#include "tests/catch.hpp"
#include "tests/experiments/bench/tiny_box.hpp"

using namespace ballast;

TEST_CASE("More iterations cost more and err less") {
  const TemporaryFolder folder;
  LiveOptions live;
  live.scene = "vibrated_box_small";
  live.overrides = tiny;
  live.solvers = parse_solvers("pgs");
  live.tolerances = {1e-8};
  live.duration = 4e-3;
  live.folder = folder.path();
  const Silence silence;
  std::vector<std::string> labels;
  const LiveComparison made = measure_accuracy(live, {2, 30}, [&](const Trajectory& t) {
    labels.push_back(t.label());
    return true;
  });
  CHECK(labels == std::vector<std::string>{"pgs 1e-08", "pgs 2 iterations", "pgs 30 iterations"});
  REQUIRE(made.trajectories.size() == 3);
  for (const Trajectory& t : made.trajectories) CHECK(t.is_complete());
  CHECK(made.reference == 0);
  const std::vector<Measurement> all = accuracy_measurements(made);
  CHECK(value_of(all, "pgs 1e-08/error_max") <= 1e-8);
  CHECK(value_of(all, "pgs 1e-08/distance_end") == 0.0);
  CHECK(value_of(all, "pgs 2 iterations/iterations_mean") == 2.0);
  CHECK(value_of(all, "pgs 2 iterations/error_mean") >
        value_of(all, "pgs 30 iterations/error_mean"));
  CHECK(value_of(all, "pgs 2 iterations/distance_end") > 0.0);
  // 2e-4 s a step: a second of them
  CHECK(value_of(all, "pgs 30 iterations/cost of a simulated second") ==
        Approx(5.0 * value_of(all, "pgs 30 iterations/ms_per_step")));
  CHECK(accuracy_figure(made).panels[0].curves.at(0).x.size() == 3);
}
