// A run's numbers for figures over many runs, on records whose answers are known.

#include "experiments/measure/observables.hpp"

#include <cmath>

#include "tests/catch.hpp"
#include "tests/support/synthetic_run.hpp"

using namespace ballast;

TEST_CASE("the paper's figures and the run's page have the same numbers of a run") {
  SyntheticBox box;
  box.frequency = GENERATE(2.5, 5.0, 20.0);
  box.duration = std::max(1.0, 3.0 / box.frequency);
  const auto steps = synthetic_box(box);
  const RunSummary page = summarise(steps, facts_of(box));
  const Observation seen = observe(steps, facts_of(box), 100.0);
  REQUIRE(seen.periods > 0);
  REQUIRE(std::isfinite(seen.rise));
  REQUIRE(std::isfinite(seen.gain));
  CHECK(seen.periods == static_cast<int>(page.wall.periods.size()));
  CHECK(seen.rise == page.rise.mean);
  CHECK(seen.speed_in == page.speed_in.mean);
  CHECK(seen.net == -page.net.mean);
  CHECK(seen.gain == page.compaction.gain);
  CHECK(seen.gain / seen.solid_reference == page.compaction.relative_gain);
  CHECK(seen.rate == page.compaction.rate);
  CHECK(seen.rise / seen.eq3() == page.prefactor);
  CHECK(seen.first_contraction == page.contraction.size);
  CHECK(seen.first_time90 == page.contraction.time90);
  CHECK(seen.penetration_max == page.penetration_max);
}

TEST_CASE("observables of a record made from formulas") {
  SyntheticBox box;
  box.noise = 0.0;
  box.duration = 2.0;
  const auto steps = synthetic_box(box);
  const Observation seen = observe(steps, facts_of(box), 100.0);
  CHECK(seen.periods == 8);  // from 0.4 s, the first whole period after 0.3 s
  CHECK(seen.net == Approx(box.ratchet).epsilon(0.02));
  CHECK(seen.gain == Approx(box.solid_gain).epsilon(0.02));
  CHECK(seen.rate == Approx(box.solid_gain * box.frequency / seen.solid_reference).epsilon(0.02));
  CHECK(seen.rate_common == Approx(seen.rate).epsilon(0.02));
  CHECK(seen.first_contraction == Approx(box.first_contraction).epsilon(0.05));
  // Delta x_max: the same stroke by hand, from the record between two jams
  double least = 1e300, rise = 0.0, in = 0.0;
  for (const StepRecord& step : steps) {
    if (step.time <= 0.8 + 1e-9 || step.time > 1.0 + 1e-9) continue;
    least = std::min(least, step.wall_x);
    rise = std::max(rise, step.wall_x - least);
    in = std::max(in, -step.wall_v);
  }
  CHECK(seen.rise == Approx(rise).epsilon(0.02));
  CHECK(seen.speed_in == Approx(in).epsilon(0.02));
  CHECK(seen.eq3() == Approx(0.5 * box.grain_mass * 9.81 / box.f_max * 9.81 / 25.0));
  const double one = box.grain_mass / 100.0;
  CHECK(seen.eq3_one_grain() ==
        Approx(one / (one + box.wall_mass) * one * 9.81 / box.f_max * 9.81 / 25.0));
}

TEST_CASE("a window cuts periods that end after it, and what is too short is not known") {
  SyntheticBox box;
  box.noise = 0.0;
  const auto steps = synthetic_box(box);
  CHECK(observe(steps, facts_of(box), 100.0, {0.3, 0.8}).periods == 2);
  CHECK(observe(steps, facts_of(box), 100.0, {0.3, 0.79}).periods == 1);
  const Observation none = observe(steps, facts_of(box), 100.0, {0.9, 1.0});
  CHECK(none.periods == 0);
  CHECK(std::isnan(none.rise));
}
