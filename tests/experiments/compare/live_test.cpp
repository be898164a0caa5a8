// The closed loop from one start: equal settings are equal bits, looser tolerances are farther from
// the reference.

#include "experiments/compare/live.hpp"

#include <iostream>
#include <sstream>

#include "experiments/compare/compare_options.hpp"
#include "platform/atomic_file.hpp"
#include "tests/catch.hpp"
#include "tests/support/temporary_folder.hpp"

using namespace ballast;

namespace {

/// A dozen grains in a driven box.
LiveOptions small_live(const std::filesystem::path& folder) {
  LiveOptions options;
  options.scene = "vibrated_box_small";
  options.overrides = {"grains.count=12", "box.length=0.12", "box.width=0.12",
                       "control_volume.margin_x=0.02"};
  options.solvers = parse_solvers("pgs,nncg");
  options.tolerances = {1e-2, 1e-8};
  options.start = 2e-3;
  options.duration = 4e-3;
  options.max_seconds = 5.0;
  options.folder = folder;
  return options;
}

struct Silence {
  Silence() : out(std::cout.rdbuf(sink.rdbuf())), err(std::cerr.rdbuf(sink.rdbuf())) {}
  ~Silence() {
    std::cout.rdbuf(out);
    std::cerr.rdbuf(err);
  }
  std::ostringstream sink;
  std::streambuf *out, *err;
};

}  // namespace

TEST_CASE("One start under several backends and tolerances") {
  const TemporaryFolder folder;
  const LiveOptions options = small_live(folder.path());
  LiveComparison comparison, again;
  {
    const Silence silence;
    comparison = run_live(options, [](const Trajectory&) { return true; });
    again = run_live(options, [](const Trajectory&) { return true; });
  }
  REQUIRE(comparison.trajectories.size() == 4);
  CHECK(comparison.has_driven_wall);
  for (const Trajectory& t : comparison.trajectories) {
    INFO(t.label());
    CHECK(t.ended == "complete");
    REQUIRE(t.steps.size() == 20);
    CHECK(t.frame_times.front() == Approx(2e-3));
    CHECK(t.frame_times.back() == Approx(6e-3));
    CHECK(t.positions.front() == comparison.trajectories[0].positions.front());  // the same start
    CHECK(t.positions.back().size() == 36);
    for (const StepRecord& step : t.steps)
      CHECK(step.error_rms <= t.tolerance * comparison.velocity_scale);
  }
  REQUIRE(comparison.reference == 2);  // pgs 1e-8: tightest, first listed
  const Trajectory& reference = comparison.trajectories[2];
  const double loose = distances(comparison.trajectories[0], reference).back();
  const double other_backend = distances(comparison.trajectories[3], reference).back();
  CHECK(distances(reference, reference).back() == 0.0);
  CHECK(loose > 0.0);
  CHECK(other_backend < loose);
  // from the files now: the same
  REQUIRE(again.trajectories.size() == 4);
  for (size_t k = 0; k < 4; ++k)
    CHECK(again.trajectories[k].positions.back() == comparison.trajectories[k].positions.back());
  // a damaged one is made again
  for (const auto& file : std::filesystem::directory_iterator(folder.path() / "trajectories"))
    write_whole_file(file.path(), read_whole_file(file.path()).substr(0, 300));
  {
    const Silence silence;
    again = run_live(options, [](const Trajectory&) { return true; });
  }
  for (size_t k = 0; k < 4; ++k) {
    CHECK(again.trajectories[k].steps.size() == 20);
    CHECK(again.trajectories[k].positions.back() == comparison.trajectories[k].positions.back());
  }
}

TEST_CASE("Distances are rms over grains at common frames") {
  Trajectory a, b;
  a.positions = {Eigen::VectorXd::Zero(6), Eigen::VectorXd::Zero(6), Eigen::VectorXd::Zero(6)};
  b.positions = {Eigen::VectorXd::Zero(6), Eigen::VectorXd::Zero(6)};
  b.positions[1] << 3.0, 4.0, 0.0, 0.0, 0.0, 5.0;
  CHECK(distances(a, b) == std::vector<double>{0.0, 5.0});
}

TEST_CASE("A trajectory is called after its solver, its limit and a law that is not Coulomb's") {
  Trajectory t;
  t.solver = "pgs";
  t.law = "coulomb";
  t.tolerance = 1e-4;
  CHECK(t.label() == "pgs 0.0001");
  t.max_iterations = 50;
  CHECK(t.label() == "pgs 50 iterations");
  t.law = "convex";
  CHECK(t.label() == "pgs 50 iterations (convex)");
}
