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
  CHECK(transient_of(10.0, {0.5, 1.0}) == 0.5);
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

TEST_CASE("a window's end cuts periods that end after it") {
  const auto steps = swinging(5.0, 1.0, 1e-3, 1.0);
  WallSettings settings;
  settings.window.end = 0.8;
  CHECK(wall_cycles(steps, 5.0, 1e-3, settings).periods.size() == 2);
  settings.window.end = 0.79;
  CHECK(wall_cycles(steps, 5.0, 1e-3, settings).periods.size() == 1);
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

TEST_CASE("a jam that gives way as a spring, and creeps, has that stiffness and that creep") {
  // out by 1 cm and back in the first half of each period; then x = -f/k, creeping inwards
  const double h = 1e-4, frequency = 5.0, stiffness = 1e7, creep = -1e-5, f_max = 6000.0;
  std::vector<StepRecord> steps;
  for (long k = 1; k <= std::lround(1.0 / h); ++k) {
    StepRecord s;
    s.time = static_cast<double>(k) * h;
    const double turn = s.time * frequency, phase = turn - std::floor(turn),
                 omega = 2.0 * std::numbers::pi * frequency;
    s.load = s.wall_force = 0.5 * f_max * (1.0 - std::sin(omega * s.time));
    const double rate = -0.5 * f_max * omega * std::cos(omega * s.time);
    s.wall_v = phase < 0.5 ? 0.1 * std::sin(2.0 * omega * s.time) : creep - rate / stiffness;
    s.wall_x = phase < 0.5 ? 0.01 * std::sin(omega * s.time) : 0.0;
    steps.push_back(s);
  }
  WallSettings settings;
  settings.smoothing = 0.0;
  const WallCycles cycles = wall_cycles(steps, frequency, h, settings);
  const JammedState jam = jammed_state(steps, cycles, 0.0, f_max);
  REQUIRE(jam.samples > 100);
  CHECK(jam.stiffness == Approx(stiffness).epsilon(1e-4));
  CHECK(jam.creep == Approx(creep).epsilon(1e-4));
  CHECK(jam.compliance_error < 1e-3 * jam.compliance);
}

TEST_CASE("a frequency or a step that is not positive is refused") {
  const auto steps = swinging(5.0, 1.0, 1e-3, 1.0);
  CHECK_THROWS_AS(wall_cycles(steps, 0.0, 1e-3), std::invalid_argument);
  CHECK_THROWS_AS(wall_cycles(steps, 5.0, not_known), std::invalid_argument);
  CHECK(wall_cycles({}, 5.0, 1e-3).periods.empty());
}

}  // namespace
}  // namespace ballast
