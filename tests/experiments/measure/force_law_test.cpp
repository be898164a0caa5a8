// The laws of f_g against made-up strokes whose parameters are known.

#include "experiments/measure/force_law.hpp"

#include <cmath>
#include <numbers>

#include "experiments/measure/run_summary.hpp"
#include "tests/catch.hpp"

using namespace ballast;

namespace {

/// A wall that carries a mass of grains which push with a constant force, jammed where it started
/// until the load falls below that force. f_g follows from Eq. 2.
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

}  // namespace

TEST_CASE("a carried mass and a constant push are found again, and Eq. 3's constant from them") {
  const CarriedWall wall;
  const auto steps = wall.record(1.0);
  WallSettings sharp;
  sharp.smoothing = 0.0;
  const WallCycles cycles = wall_cycles(steps, wall.frequency, wall.h, sharp);
  REQUIRE(cycles.periods.size() == 3);
  const ForceLaw law = force_law(steps, cycles, wall.grain_mass, wall.wall_mass, 9.81, sharp);
  const double w = wall.carried / (wall.carried + wall.wall_mass);
  CHECK(law.by_load.slope == Approx(w).epsilon(1e-6));
  CHECK(law.by_load.offset == Approx(wall.push * (1.0 - w)).epsilon(1e-6));
  CHECK(law.by_load.r2 == Approx(1.0));
  CHECK(law.push == Approx(wall.push).epsilon(1e-6));
  CHECK(law.carried_mass == Approx(wall.carried).epsilon(1e-6));
  // the stroke of the made-up wall obeys the constant, as f_max is 600 times the push
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
  WallSettings sharp;
  sharp.smoothing = 0.0;
  const WallCycles moved = wall_cycles(steps, wall.frequency, wall.h, sharp);
  // the same motion with forces that follow the place alone
  const double rate = 3.0 / moved.periods.front().rise;
  for (StepRecord& s : steps)
    if (s.wall_v > 0.0) s.wall_force = 100.0 * std::exp(rate * s.wall_x);
  const WallCycles cycles = wall_cycles(steps, wall.frequency, wall.h, sharp);
  const ForceLaw law = force_law(steps, cycles, wall.grain_mass, wall.wall_mass, 9.81, sharp);
  CHECK(law.by_place.amplitude == Approx(100.0).epsilon(1e-3));
  CHECK(law.by_place.rate == Approx(rate).epsilon(1e-3));
  CHECK(law.by_place.r2 > 0.999);
  CHECK(1.0 - law.by_load.r2 > 20.0 * (1.0 - law.by_place.r2));
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
