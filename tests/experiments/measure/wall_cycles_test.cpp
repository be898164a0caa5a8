// The periods of a record that count, their strokes, and the laws of f_g, on made-up strokes of
// known parameters. run_summary_test.cpp tests the phases, on whole made-up runs.

#include "experiments/measure/wall_cycles.hpp"

#include <cmath>
#include <numbers>
#include <stdexcept>

#include "experiments/measure/run_summary.hpp"
#include "tests/catch.hpp"

namespace ballast {
namespace {

/// x = size (1 - cos)/2 once a period: moves from rest at 0 to `size` and back.
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

/// A wall that carries a mass of grains, which push with a constant force. It is jammed at its
/// start until the load falls below that force. f_g follows from Eq. 2.
struct CarriedWall {
  double grain_mass = 200.0, wall_mass = 100.0, carried = 60.0;  ///< [kg]
  double push = 500.0, f_max = 3e5;                              ///< [N]: far above the push
  double frequency = 5.0, h = 2e-5;

  std::vector<StepRecord> record(double duration) const {
    std::vector<StepRecord> steps;
    double x = 0.0, v = 0.0;
    for (long k = 1; k <= std::lround(duration / h); ++k) {
      StepRecord s;
      s.time = static_cast<double>(k) * h;
      s.load = 0.5 * f_max * (1.0 - std::sin(2.0 * std::numbers::pi * frequency * s.time));
      const double a = (push - s.load) / (wall_mass + carried);
      const bool jams = x <= 0.0 && v <= 0.0 && a <= 0.0;
      v = jams ? 0.0 : v + h * a;
      x = jams ? 0.0 : x + h * v;
      s.wall_x = x;
      s.wall_v = v;
      s.wall_force = jams ? s.load : s.load + wall_mass * a;
      steps.push_back(s);
    }
    return steps;
  }
};

TEST_CASE("whole periods after the transient count: 2 at 1 Hz, 3 at 5 Hz, 42 at 60 Hz") {
  const auto count = [](double frequency, double duration) {
    return wall_cycles(swinging(frequency, duration, 1e-3, 1.0), frequency, 1e-3).periods.size();
  };
  CHECK(count(1.0, 3.0) == 2);
  CHECK(count(5.0, 1.0) == 3);
  CHECK(count(60.0, 1.0) == 42);
  CHECK(count(5.0, 0.59) == 0);
  CHECK(count(5.0, 0.6) == 1);
  // The periods are shorter than a step.
  CHECK(count(2e3, 1.0) == 0);
  CHECK(count(1e30, 1.0) == 0);
}

TEST_CASE("a frequency or a step that is not positive is refused") {
  const auto steps = swinging(5.0, 1.0, 1e-3, 1.0);
  CHECK_THROWS_AS(wall_cycles(steps, 0.0, 1e-3), std::invalid_argument);
  CHECK_THROWS_AS(wall_cycles(steps, 5.0, not_known), std::invalid_argument);
  CHECK(wall_cycles({}, 5.0, 1e-3).periods.empty());
}

TEST_CASE("a carried mass and a constant push are found again, and Eq. 3's constant from them") {
  const CarriedWall wall;
  const auto steps = wall.record(1.0);
  const WallCycles cycles = wall_cycles(steps, wall.frequency, wall.h, 0.0);
  REQUIRE(cycles.periods.size() == 3);
  const ForceLaw law = force_law(steps, cycles, wall.grain_mass, wall.wall_mass, 9.81);
  const double w = wall.carried / (wall.carried + wall.wall_mass);
  CHECK(law.by_load.slope == Approx(w).epsilon(1e-6));
  CHECK(law.by_load.offset == Approx(wall.push * (1.0 - w)).epsilon(1e-6));
  CHECK(law.by_load.r2 == Approx(1.0));
  CHECK(law.push == Approx(wall.push).epsilon(1e-6));
  CHECK(law.carried_mass == Approx(wall.carried).epsilon(1e-6));
  // The stroke of the made-up wall obeys the constant, as f_max is 600 times the push.
  RunFacts facts;
  facts.grain_mass = wall.grain_mass;
  facts.wall_mass = wall.wall_mass;
  facts.gravity = 9.81;
  facts.f_max = wall.f_max;
  facts.frequency = wall.frequency;
  for (const WallPeriod& period : cycles.periods)
    CHECK(period.rise / eq3_displacement(facts) == Approx(law.prefactor).epsilon(0.01));
}

TEST_CASE("an exponential in the place is told from a law of the load") {
  CarriedWall wall;
  auto steps = wall.record(1.0);
  const WallCycles moved = wall_cycles(steps, wall.frequency, wall.h, 0.0);
  // The same motion with forces that depend on the position alone.
  const double rate = 3.0 / moved.periods.front().rise;
  for (StepRecord& s : steps)
    if (s.wall_v > 0.0) s.wall_force = 100.0 * std::exp(rate * s.wall_x);
  const WallCycles cycles = wall_cycles(steps, wall.frequency, wall.h, 0.0);
  const ForceLaw law = force_law(steps, cycles, wall.grain_mass, wall.wall_mass, 9.81);
  CHECK(law.active.amplitude == Approx(100.0).epsilon(1e-3));
  CHECK(law.active.rate == Approx(rate).epsilon(1e-3));
  CHECK(law.active.r2 > 0.999);
  CHECK(1.0 - law.by_load.r2 > 20.0 * (1.0 - law.active.r2));
}

TEST_CASE("a slope that no carried mass has makes the theory not known") {
  CarriedWall wall;
  auto steps = wall.record(1.0);
  for (StepRecord& s : steps) s.wall_force = 1000.0 - 0.01 * s.load;
  const WallCycles cycles = wall_cycles(steps, wall.frequency, wall.h);
  const ForceLaw law = force_law(steps, cycles, wall.grain_mass, wall.wall_mass, 9.81);
  CHECK(law.by_load.slope == Approx(-0.01).epsilon(0.05));
  CHECK(std::isnan(law.push));
  CHECK(std::isnan(law.prefactor));
  CHECK(std::isnan(force_law({}, {}, 1.0, 1.0, 9.81).prefactor));
}

}  // namespace
}  // namespace ballast
