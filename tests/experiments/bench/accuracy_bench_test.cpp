// What a simulated second costs at which error.

#include "experiments/bench/accuracy_bench.hpp"

#include "experiments/compare/compare_options.hpp"
#include "tests/catch.hpp"
#include "tests/experiments/bench/tiny_box.hpp"

using namespace ballast;

TEST_CASE("More iterations cost more and err less") {
  const TemporaryFolder folder;
  AccuracyOptions options;
  options.live.scene = "vibrated_box_small";
  options.live.overrides = tiny;
  options.live.solvers = parse_solvers("pgs");
  options.live.tolerances = {1e-8};
  options.live.duration = 4e-3;
  options.live.folder = folder.path();
  options.iterations = {2, 30};
  const Silence silence;
  std::vector<std::string> labels;
  const auto rows = measure_accuracy(options, [&](const Trajectory& t) {
    labels.push_back(t.label());
    return true;
  });
  REQUIRE(rows.size() == 3);
  CHECK(labels == std::vector<std::string>{"pgs 1e-08", "pgs 2 iterations", "pgs 30 iterations"});
  for (const AccuracyRow& row : rows) CHECK(row.complete);
  CHECK(rows[0].error_worst <= 1e-8);
  CHECK(rows[0].distance == 0.0);
  CHECK(rows[1].limit == "2 iterations");
  CHECK(rows[1].iterations == 2.0);
  CHECK(rows[1].error_mean > rows[2].error_mean);
  CHECK(rows[1].distance > 0.0);
  CHECK(value_of(accuracy_measurements(rows), "pgs, 30 iterations/iterations") == 30.0);
}
