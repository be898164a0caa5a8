// A trajectory's distances, its name, and its file.

#include "experiments/compare/trajectory.hpp"

#include <cmath>

#include "platform/atomic_file.hpp"
#include "platform/error.hpp"
#include "tests/catch.hpp"
#include "tests/support/temporary_folder.hpp"

using namespace ballast;

namespace {

Trajectory two_frames() {
  Trajectory t;
  t.solver = "pgs";
  t.law = "coulomb";
  t.tolerance = 1e-4;
  t.ended = "failed: no more \"contacts\"";
  for (int k = 0; k < 3; ++k) {
    StepRecord step;
    double value = 0.1 * k;
    for (const StepColumn& column : step_columns()) step.*column.value = value += 1.0 / 3.0;
    step.solid_fraction = std::nan("");
    t.steps.push_back(step);
  }
  t.frame_times = {0.0, 1e-3};
  t.positions = {Eigen::VectorXd::LinSpaced(6, 0.0, 1.0),
                 Eigen::VectorXd::LinSpaced(6, 5e-324, 2.0)};
  return t;
}

}  // namespace

TEST_CASE("Distances are rms over grains at common frames") {
  Trajectory a, b;
  a.positions = {Eigen::VectorXd::Zero(6), Eigen::VectorXd::Zero(6), Eigen::VectorXd::Zero(6)};
  b.positions = {Eigen::VectorXd::Zero(6), Eigen::VectorXd::Zero(6)};
  b.positions[1] << 3.0, 4.0, 0.0, 0.0, 0.0, 5.0;
  CHECK(distances(a, b) == std::vector<double>{0.0, 5.0});
}

TEST_CASE("A trajectory is called after its solver, its limit and a law that is not Coulomb's") {
  Trajectory t = two_frames();
  CHECK(t.label() == "pgs 0.0001");
  t.max_iterations = 50;
  CHECK(t.label() == "pgs 50 iterations");
  t.law = "convex";
  CHECK(t.label() == "pgs 50 iterations (convex)");
}

TEST_CASE("A trajectory survives its file to the last bit") {
  const TemporaryFolder folder;
  const auto file = folder.path() / "t.bin";
  const Trajectory t = two_frames();
  write_trajectory(file, t);
  Trajectory back;
  read_trajectory(file, back);
  CHECK(packed(back) == packed(t));
  CHECK(back.ended == t.ended);
  REQUIRE(back.steps.size() == 3);
  CHECK(std::isnan(back.steps[2].solid_fraction));
  CHECK(back.steps[2].seconds_other == t.steps[2].seconds_other);
  CHECK(back.frame_times == t.frame_times);
  CHECK(back.positions == t.positions);
}

TEST_CASE("A damaged trajectory is refused by name") {
  const TemporaryFolder folder;
  const auto file = folder.path() / "t.bin";
  const Trajectory t = two_frames();
  write_trajectory(file, t);
  const std::string whole = read_whole_file(file);
  Trajectory back;
  for (const size_t size : {size_t{0}, size_t{5}, size_t{30}, whole.size() - 1}) {
    write_whole_file(file, whole.substr(0, size));
    CHECK_THROWS_WITH(read_trajectory(file, back), Catch::StartsWith(file.string()));
  }
  std::string turned = whole;
  turned[whole.size() / 2] ^= 1;
  write_whole_file(file, turned);
  CHECK_THROWS_AS(read_trajectory(file, back), Error);
  // a frame without its time, well packed
  Trajectory uneven = t;
  uneven.frame_times.pop_back();
  CHECK_THROWS_WITH(unpack(packed(uneven), "child", back), Catch::StartsWith("child"));
  CHECK_THROWS_WITH(unpack(packed(t) + "x", "child", back), Catch::StartsWith("child"));
}
