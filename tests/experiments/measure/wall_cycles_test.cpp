// Which periods of a record count, and the strokes in them. Phases and fits of the loop are in
// run_summary_test.cpp, on whole made-up runs.

#include "experiments/measure/wall_cycles.hpp"

#include <cmath>
#include <numbers>
#include <stdexcept>

#include "tests/catch.hpp"

namespace ballast {
namespace {

/// x = size (1 - cos)/2 once a period: from rest at 0 out to `size` and back.
std::vector<StepRecord> swinging(double frequency, double duration, double h, double size) {
  std::vector<StepRecord> steps;
  for (long k = 1; k <= std::lround(duration / h); ++k) {
    StepRecord step;
    step.time = static_cast<double>(k) * h;
    const double angle = 2.0 * std::numbers::pi * frequency * step.time;
    step.wall_x = 0.5 * size * (1.0 - std::cos(angle));
    step.wall_v = size * std::numbers::pi * frequency * std::sin(angle);
    step.load = 1.0 - std::sin(angle);
    steps.push_back(step);
  }
  return steps;
}

TEST_CASE("the transient is 0.3 s or a period, whichever is longer") {
  CHECK(transient_of(1.0) == 1.0);
  CHECK(transient_of(5.0) == 0.3);
  CHECK(transient_of(60.0) == 0.3);
}

TEST_CASE("whole periods after the transient count: 2 at 1 Hz, 3 at 5 Hz, 42 at 60 Hz") {
  const auto count = [](double frequency, double duration) {
    return wall_cycles(swinging(frequency, duration, 1e-3, 1.0), frequency, 1e-3).periods.size();
  };
  CHECK(count(1.0, 3.0) == 2);
  CHECK(count(5.0, 1.0) == 3);
  CHECK(count(60.0, 1.0) == 42);
  CHECK(count(5.0, 0.59) == 0);
  CHECK(count(5.0, 0.6) == 1);
}

TEST_CASE("the stroke of a swinging wall is its swing") {
  const double size = 2e-3, frequency = 5.0;
  const WallCycles cycles = wall_cycles(swinging(frequency, 1.0, 1e-4, size), frequency, 1e-4);
  for (const WallPeriod& period : cycles.periods) {
    CHECK(period.rise == Approx(size).epsilon(1e-4));
    CHECK(period.net == Approx(0.0).margin(1e-12));
    CHECK(period.speed_in == Approx(std::numbers::pi * frequency * size).epsilon(1e-4));
    CHECK(period.speed_out == Approx(period.speed_in).epsilon(1e-9));
    CHECK(period.x_after == Approx(0.0).margin(1e-9));
  }
}

TEST_CASE("a frequency or a step that is not positive is refused") {
  const auto steps = swinging(5.0, 1.0, 1e-3, 1.0);
  CHECK_THROWS_AS(wall_cycles(steps, 0.0, 1e-3), std::invalid_argument);
  CHECK_THROWS_AS(wall_cycles(steps, 5.0, not_known), std::invalid_argument);
  CHECK(wall_cycles({}, 5.0, 1e-3).periods.empty());
}

}  // namespace
}  // namespace ballast
