#include "experiments/measure/run_summary.hpp"

#include <cmath>
#include <numbers>

#include "tests/catch.hpp"
#include "tests/support/synthetic_run.hpp"

namespace ballast {
namespace {

SyntheticBox bare_box() {
  SyntheticBox box;
  box.noise = 0.0;
  return box;
}

TEST_CASE("the loop's fits give back the law it was made from") {
  const SyntheticBox box = bare_box();
  const auto steps = synthetic_box(box);
  const RunFacts facts = facts_of(box);
  const WallCycles unsmoothed = wall_cycles(steps, facts.frequency, facts.step, 0.0);
  REQUIRE(unsmoothed.periods.size() == 3);
  const ForceLaw law =
      force_law(steps, unsmoothed, facts.grain_mass, facts.wall_mass, facts.gravity);
  CHECK(law.active.amplitude == Approx(box.active_force).epsilon(1e-6));
  CHECK(law.active.rate == Approx(box.active_rate).epsilon(1e-5));
  CHECK(law.active.r2 == Approx(1.0).epsilon(1e-9));
  CHECK(law.passive.offset == Approx(box.passive_force).epsilon(1e-9));
  CHECK(law.passive.slope == Approx(-box.passive_slope).epsilon(1e-9));
  CHECK(law.passive.r2 == Approx(1.0).epsilon(1e-9));
}

TEST_CASE("with noise of 25 % per step the smoothed loop still has the same fits") {
  SyntheticBox box;
  box.duration = 3.6;  // enough periods to average out the noise of a stroke
  const RunSummary summary = summarise(synthetic_box(box), facts_of(box));
  CHECK(summary.law.active.amplitude == Approx(box.active_force).epsilon(0.03));
  CHECK(summary.law.active.rate == Approx(box.active_rate).epsilon(0.15));
  CHECK(summary.law.passive.offset == Approx(box.passive_force).epsilon(0.04));
  CHECK(summary.law.passive.slope == Approx(-box.passive_slope).epsilon(0.08));
}

TEST_CASE("strokes: against every pair of samples") {
  const auto steps = synthetic_box();
  const RunSummary summary = summarise(steps, facts_of({}));
  REQUIRE(summary.wall.periods.size() == 3);
  for (const WallPeriod& period : summary.wall.periods) {
    double rise = 0.0;
    for (size_t i = period.first; i < period.last; ++i)
      for (size_t j = i; j < period.last; ++j)
        rise = std::max(rise, steps[j].wall_x - steps[i].wall_x);
    CHECK(period.rise == rise);
    CHECK(steps[period.peak].wall_x == period.x_peak);
    CHECK(period.x_peak - period.x_before == rise);
    CHECK(period.yield_load == Approx(SyntheticBox{}.active_force).margin(25.0));  // two steps
    CHECK(period.net == Approx(-SyntheticBox{}.ratchet).epsilon(1e-9));
    CHECK(period.last - period.first == 1000);
    CHECK(period.x_after == Approx(period.x_before - SyntheticBox{}.ratchet).epsilon(1e-9));
  }
  CHECK(summary.wall.periods[0].begin == Approx(0.4));
  CHECK(summary.wall.periods[2].end == Approx(1.0));
}

TEST_CASE("phases: outwards active, inwards passive, at rest under the load jammed") {
  const SyntheticBox box = bare_box();
  const auto steps = synthetic_box(box);
  const RunSummary summary = summarise(steps, facts_of(box));
  const WallCycles& wall = summary.wall;
  CHECK(wall.jammed_periods == 3);
  size_t wrong = 0, judged = 0;
  for (size_t k = 1501; k < steps.size(); ++k) {
    if (std::abs(steps[k].wall_v) > 0.1 * wall.v_peak) {
      // Smoothing blurs half a window on both sides of a jump of the velocity.
      const bool at_jump = k + 10 >= steps.size() ||
                           std::abs(steps[k + 10].wall_v - steps[k].wall_v) > 0.5 * wall.v_peak;
      if (at_jump) continue;
      ++judged;
      wrong += wall.phase[k] != (steps[k].wall_v > 0.0 ? WallPhase::active : WallPhase::passive);
    } else if (steps[k].load > 0.6 * box.f_max && std::abs(wall.velocity[k]) < 1e-4 * wall.v_peak) {
      ++judged;
      wrong += wall.phase[k] != WallPhase::jammed;
    }
  }
  CHECK(judged > 2000);
  CHECK(wrong == 0);
  for (size_t k = 0; k < 1499; ++k) REQUIRE(wall.phase[k] == WallPhase::none);
  // At the turning point of largest x the wall is slow too, but not jammed.
  for (const WallPeriod& period : wall.periods) CHECK(wall.phase[period.peak] != WallPhase::jammed);
}

TEST_CASE("the jammed state's imbalance is what was put in") {
  const SyntheticBox box = bare_box();
  auto steps = synthetic_box(box);
  for (StepRecord& step : steps) step.wall_force += 5e-4 * box.f_max;
  const JammedState jammed = summarise(steps, facts_of(box)).jammed;
  CHECK(jammed.samples > 1000);
  CHECK(jammed.force_mean == Approx(5e-4).epsilon(1e-6));
  CHECK(jammed.force_p95 == Approx(5e-4).epsilon(1e-6));
  CHECK(jammed.force_max == Approx(5e-4).epsilon(1e-6));
  CHECK(jammed.speed_max == Approx(box.jam_slip).epsilon(1e-2));
  CHECK(jammed.speed_mean == Approx(box.jam_slip * 2.0 / std::numbers::pi).epsilon(0.02));
}

TEST_CASE("a wall that swings under the load's maximum is not jammed") {
  const SyntheticBox box;
  auto steps = synthetic_box(box);
  for (StepRecord& step : steps) {
    step.wall_v = 0.1 * std::sin(2.0 * std::numbers::pi * box.frequency *
                                 step.time);  // largest speed at the load's maximum
    step.wall_x = -0.1 / (2.0 * std::numbers::pi * box.frequency) *
                  std::cos(2.0 * std::numbers::pi * box.frequency * step.time);
  }
  const RunSummary summary = summarise(steps, facts_of(box));
  CHECK(summary.wall.jammed_periods == 0);
  CHECK(summary.jammed.samples == 0);
  CHECK(std::isnan(summary.jammed.force_mean));
  CHECK(summary.speed_in.mean == Approx(0.1).epsilon(1e-3));
  CHECK(summary.rise.mean == Approx(0.2 / (2.0 * std::numbers::pi * box.frequency)).epsilon(1e-3));
}

TEST_CASE("first contraction, compaction and the prefactor of Eq. 3") {
  const SyntheticBox box = bare_box();
  const RunSummary summary = summarise(synthetic_box(box), facts_of(box));
  CHECK(summary.contraction.size == Approx(box.first_contraction + box.ratchet).epsilon(0.01));
  CHECK(summary.contraction.time90 ==
        Approx(0.15 * std::acos(-0.8) / std::numbers::pi).margin(3e-3));
  CHECK(summary.facts.solid_fraction_initial == box.solid_initial);
  CHECK(summary.compaction.reference == Approx(box.solid_initial + box.solid_jump));
  // The solid fraction grows by the linear gain, and by the ratchet through the term -0.4 x.
  CHECK(summary.compaction.gain == Approx(box.solid_gain + 0.4 * box.ratchet).epsilon(1e-3));
  CHECK(summary.compaction.relative_gain ==
        Approx(summary.compaction.gain / summary.compaction.reference));
  CHECK(summary.compaction.rate == Approx(5.0 * summary.compaction.relative_gain).epsilon(1e-3));
  auto outward = synthetic_box(box);
  for (StepRecord& step : outward) step.wall_x = std::abs(step.wall_x);
  const FirstContraction none = summarise(outward, facts_of(box)).contraction;
  CHECK((none.size == 0.0 && std::isnan(none.time90)));
  const double eq3 = 0.5 * (214.0 * 9.81 / 6300.0) * (9.81 / 25.0);
  CHECK(summary.prefactor == Approx(summary.rise.mean / eq3));
}

TEST_CASE("the energy balance is summed from the columns, not taken from the residual's") {
  auto steps = synthetic_box();
  const double clean = summarise(steps, facts_of({})).energy.residual;
  double recorded = 0.0;
  for (const StepRecord& step : steps) recorded += step.energy_residual;
  CHECK(clean == Approx(recorded).epsilon(1e-6));
  CHECK(summarise({steps.data(), 1}, {}).energy.residual == steps[0].energy_residual);
  steps[3000].dissipated += 0.5;
  const EnergyBalance broken = summarise(steps, facts_of({})).energy;
  CHECK(broken.residual == Approx(clean + 0.5));
  CHECK(broken.relative > 0.0);
  steps[10].work_load = not_known;
  CHECK(std::isnan(summarise(steps, facts_of({})).energy.relative));
}

TEST_CASE("error, overlap and cost") {
  auto steps = synthetic_box();
  steps[1234].penetration_max = 3e-4;
  steps[2345].error_rms = 0.05;
  const RunSummary summary = summarise(steps, facts_of({}));
  const double scale = 9.81 * 2e-4;
  CHECK(summary.facts.velocity_scale == Approx(scale));
  CHECK(summary.error_max_relative == Approx(0.05 / scale));
  double sum = 0.0;
  for (const StepRecord& step : steps) sum += step.error_rms;
  CHECK(summary.error_mean_relative == Approx(sum / 5000.0 / scale));
  CHECK(summary.penetration_max == 3e-4);
  CHECK(summary.penetration_max_time == steps[1234].time);
  double phases = 0.0;
  for (const PhaseCost& phase : summary.cost) phases += phase.ms_per_step;
  CHECK(phases == Approx(summary.ms_per_step));
  CHECK(summary.cost[0].ms_per_step == Approx(3.0).epsilon(0.01));
}

TEST_CASE("the mean overlap is of all active points, not of steps") {
  auto steps = synthetic_slide();
  for (StepRecord& step : steps) step.active_contacts = 0;
  CHECK(std::isnan(summarise(steps, {}).penetration_mean));
  for (const size_t k : {1, 2}) {
    steps[k].active_contacts = static_cast<double>(k);
    steps[k].penetration_mean = 3e-6 * static_cast<double>(k);
  }
  CHECK(summarise(steps, {}).penetration_mean == Approx(5e-6));
}

TEST_CASE("a record without wall or packing has the rest") {
  const RunSummary summary = summarise(synthetic_slide(), {});
  CHECK(summary.wall.periods.empty());
  CHECK(std::isnan(summary.rise.mean));
  CHECK(summary.energy.residual == Approx(0.0).margin(1e-12));
  CHECK(std::isnan(summary.energy.relative));  // no work at all: nothing to compare with
}

TEST_CASE("too short for a period, or nothing at all") {
  SyntheticBox box;
  box.duration = 0.35;
  const RunSummary summary = summarise(synthetic_box(box), facts_of(box));
  CHECK(summary.wall.periods.empty());
  CHECK(std::isnan(summary.law.active.rate));
  CHECK(std::isnan(summary.compaction.gain));
  CHECK(std::isnan(summary.compaction.rate));
  CHECK(summary.compaction.reference == Approx(0.519).epsilon(1e-3));
  const RunSummary empty = summarise({}, {});
  CHECK(empty.steps == 0);
  CHECK(std::isnan(empty.ms_per_step));
}

TEST_CASE("columns that are all NaN are not known, never zero") {
  auto steps = synthetic_box();
  for (StepRecord& step : steps)
    step.wall_x = step.penetration_max = step.solid_fraction = step.seconds_solve = not_known;
  const RunSummary summary = summarise(steps, facts_of({}));
  CHECK(std::isnan(summary.rise.mean));
  CHECK(std::isnan(summary.contraction.size));
  CHECK(std::isnan(summary.penetration_max));
  CHECK(std::isnan(summary.compaction.reference));
  CHECK(std::isnan(summary.compaction.gain));
  CHECK(std::isnan(summary.cost[2].ms_per_step));
}

TEST_CASE("single NaN samples are passed over") {
  auto steps = synthetic_box();
  const RunSummary clean = summarise(steps, facts_of({}));
  for (size_t k = 1500; k < 5000; k += 500)
    steps[k].wall_x = steps[k].wall_force = steps[k].error_rms = not_known;
  const RunSummary summary = summarise(steps, facts_of({}));
  CHECK(summary.rise.mean == Approx(clean.rise.mean).epsilon(1e-2));
  CHECK(summary.error_mean_relative == Approx(clean.error_mean_relative).epsilon(1e-2));
  CHECK(summary.law.passive.slope == Approx(clean.law.passive.slope).epsilon(1e-2));
}

constexpr double row_step = 1e-3, load_frequency = 5.0;

/// rho grows by `gain` a period; its swing within a period must not count.
std::vector<StepRecord> growing(double gain, double duration) {
  std::vector<StepRecord> steps;
  for (long k = 1; k <= std::lround(duration / row_step); ++k) {
    StepRecord step;
    step.time = static_cast<double>(k) * row_step;
    const double turns = step.time * load_frequency;
    step.solid_fraction = 0.5 + gain * turns + 0.01 * std::sin(2.0 * std::numbers::pi * turns);
    steps.push_back(step);
  }
  return steps;
}

RunFacts packing_facts() {
  RunFacts facts;
  facts.frequency = load_frequency;
  facts.step = row_step;
  facts.solid_fraction_initial = 0.49;
  facts.has_wall = facts.has_packing = true;
  return facts;
}

Compaction measured(const std::vector<StepRecord>& steps) {
  return summarise(steps, packing_facts()).compaction;
}

TEST_CASE("compaction of a solid fraction that grows and swings, within the two windows of Eq. 4") {
  auto steps = growing(0.002, 2.0);
  const Compaction compaction = measured(steps);
  CHECK(compaction.reference == Approx(0.502));  // one period after the start
  CHECK(compaction.gain == Approx(0.002));
  CHECK(compaction.relative_gain == Approx(0.002 / 0.502));
  CHECK(compaction.rate == Approx(0.002 * load_frequency / 0.502));
  CHECK(compaction.rate_common == Approx(compaction.rate));
  for (StepRecord& step : steps)
    if (step.time > 1.5) step.solid_fraction += 0.01;
  CHECK(measured(steps).rate == Approx(compaction.rate + 0.01 / (0.502 * 1.8)));
  CHECK(measured(steps).rate_common == Approx(compaction.rate));  // its window ends at 1 s
}

TEST_CASE("compaction is not known where the wall enters the control volume") {
  auto steps = growing(0.002, 2.0);
  for (StepRecord& step : steps) step.wall_x = 0.01;
  RunFacts facts = packing_facts();
  facts.volume_margin = 0.08;
  steps[700].wall_x = -0.0799;
  const Compaction clear = summarise(steps, facts).compaction;
  CHECK(!clear.has_wall_inside);
  CHECK(clear.gain == Approx(0.002));
  steps[700].wall_x = -0.0801;
  const Compaction inside = summarise(steps, facts).compaction;
  CHECK(inside.has_wall_inside);
  CHECK(summarise(steps, facts).facts.solid_fraction_initial == 0.49);
  for (const double value : {inside.reference, inside.last, inside.gain, inside.relative_gain,
                             inside.rate, inside.rate_common, inside.rate_first, inside.rate_late})
    CHECK(std::isnan(value));
}

TEST_CASE("the roll of whole periods needs frames at their ends and the box") {
  RunSummary summary;
  summary.facts.step = 1e-4;
  summary.facts.grains = 25;
  summary.facts.length = summary.facts.height = 1.0;
  summary.facts.largest_size = 0.3;
  summary.wall.periods.resize(1);
  summary.wall.periods[0].begin = 0.2;
  summary.wall.periods[0].end = 0.4;
  std::vector<MotionState> frames(2);
  for (int f = 0; f < 2; ++f) {
    frames[f].time = 0.2 + 0.2 * f;
    for (int k = 0; k < 25; ++k) {
      const double x = 0.25 * (k % 5), z = 0.25 * (k / 5);  // a clockwise turn by 0.01 rad
      Pose pose;
      pose.position = Vec3(x + 0.01 * f * (z - 0.5), 0, z - 0.01 * f * (x - 0.5));
      frames[f].pose.push_back(pose);
    }
  }
  CHECK(roll_of_periods(frames, summary).side_ratio() > 0.0);
  frames.pop_back();
  CHECK(std::isnan(roll_of_periods(frames, summary).circulation));
  CHECK(std::isnan(roll_of_periods(frames, {}).circulation));
}

}  // namespace
}  // namespace ballast
