// The jams of a tiny run, loaded again under other solvers.

#include "experiments/bench/jam_bench.hpp"

#include "experiments/run/run.hpp"
#include "platform/error.hpp"
#include "tests/experiments/bench/tiny_box.hpp"

using namespace ballast;

namespace {

RunOptions tiny_run(const TemporaryFolder& folder, const char* states) {
  RunOptions options;
  options.scene = "vibrated_box_small";
  options.overrides = tiny;
  for (const char* more : {"scene.duration=0.7", "drive.frequency=10", states})
    options.overrides.emplace_back(more);
  options.output = folder.path() / "run";
  options.packing_cache = folder.path() / "packings";
  options.telling = Telling::nobody;
  return options;
}

}  // namespace

TEST_CASE("the jams of a run are loaded: stiffer with more iterations, and told row by row") {
  const TemporaryFolder folder;
  const Silence silence;
  REQUIRE(run(tiny_run(folder, "record.state_rate=200")).code == ExitCode::ok);
  JamOptions options;
  options.solvers = {"pgs", "nncg"};
  options.iterations = {2, 400};
  options.steps = {2e-4, 1e-4};
  options.states = 2;
  options.settle = options.seconds = 0.004;
  int heard = 0;
  const auto rows = measure_jams(folder.path() / "run", options, [&](const JamRow&) {
    ++heard;
    return true;
  });
  REQUIRE(rows.size() == 16);
  CHECK(heard == 16);
  CHECK(rows[0].grains == 12);
  CHECK(rows[0].force >= rows[8].force);  // the largest load first
  CHECK(rows[0].time != rows[8].time);
  for (size_t k = 0; k < rows.size(); k += 2) {
    CHECK(rows[k].iterations == 2);
    CHECK(rows[k].found.iterations == 2.0);
    CHECK(rows[k].scale == Approx(9.81 * rows[k].h));
    CHECK(rows[k + 1].found.error < 0.1 * rows[k].found.error);
    CHECK(std::abs(rows[k + 1].found.compliance) < std::abs(rows[k].found.compliance));
  }
  const auto measurements = jam_measurements(rows);
  CHECK(value_of(measurements, "pgs, 2 iterations, h 0.0002 s/iterations") == 2.0);
  CHECK_THAT(jam_csv(rows), Catch::StartsWith("time [s],force [N],grains,solver") &&
                                Catch::Contains(",12,nncg,400,0.0001,"));

  // Stopped after the first row; and a run that keeps no states.
  const auto stop = [](const JamRow&) { return false; };
  CHECK(measure_jams(folder.path() / "run", options, stop).size() == 1);
  std::filesystem::remove_all(folder.path() / "run" / "states");
  CHECK_THROWS_AS(measure_jams(folder.path() / "run", options, stop), Error);
}
