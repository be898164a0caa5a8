#include "experiments/measure/observables.hpp"

#include <array>
#include <cmath>

namespace ballast {
namespace {

/// Wall clock: a machine that does something else for a while must not count.
double median_step_seconds(std::span<const StepRecord> steps) {
  std::vector<double> seconds;
  for (const StepRecord& step : steps) seconds.push_back(step_seconds(step));
  return quantile(seconds, 0.5);
}

/// Mean of the judge's rms error over the steps that count, in units of the velocity scale.
double mean_error(std::span<const StepRecord> steps, const RunFacts& facts,
                  const TimeWindow& window) {
  const double begin = transient_of(facts.frequency, window), end = window.end + 0.25 * facts.step;
  std::vector<double> errors;
  for (const StepRecord& step : steps)
    if (step.time > begin && step.time <= end) errors.push_back(step.error_rms);
  return statistics(errors).mean / facts.velocity_scale;
}

}  // namespace

double Observation::eq3() const { return eq3_displacement(facts); }

double Observation::eq3_one_grain() const {
  RunFacts one = facts;
  one.grain_mass = mean_grain_mass;
  return eq3_displacement(one);
}

Observation observe(std::span<const StepRecord> steps, const RunFacts& facts, double grains,
                    const TimeWindow& window) {
  WallSettings settings;
  settings.window = window;
  const RunSummary summary = summarise(steps, facts, settings);
  Observation seen;
  seen.facts = summary.facts;
  seen.mean_grain_mass = seen.facts.grain_mass / grains;
  seen.steps = summary.steps;
  if (steps.empty() || !(seen.facts.frequency > 0.0) || !(seen.facts.step > 0.0)) return seen;

  seen.periods = static_cast<int>(summary.wall.periods.size());
  seen.rise = summary.rise.mean;
  seen.speed_in = summary.speed_in.mean;
  // Outwards is positive, and the packing contracts inwards: the sign is turned.
  seen.net = -summary.net.mean;
  seen.gain = summary.compaction.gain;
  seen.relative_gain = summary.compaction.relative_gain;
  seen.dissipated = summary.dissipated.mean;

  seen.solid_initial = summary.compaction.initial;
  seen.solid_reference = summary.compaction.reference;
  seen.rate = summary.compaction.rate;
  seen.rate_common = summary.compaction.rate_common;
  seen.first_contraction = summary.contraction.size;
  seen.first_time90 = summary.contraction.time90;
  seen.error_mean = mean_error(steps, seen.facts, window);
  seen.penetration_max = summary.penetration_max;
  seen.seconds_per_step = median_step_seconds(steps);
  return seen;
}

std::span<const ObservableColumn> observable_columns() {
  static constexpr std::array columns{
      ObservableColumn{"Δx_max", "mm", 1e3, &Observation::rise},
      ObservableColumn{"v_max", "mm/s", 1e3, &Observation::speed_in},
      ObservableColumn{"net contraction per period", "mm", 1e3, &Observation::net},
      ObservableColumn{"Δρ_1", "10⁻³", 1e3, &Observation::gain},
      ObservableColumn{"first contraction", "mm", 1e3, &Observation::first_contraction},
      ObservableColumn{"dissipated per period", "J", 1.0, &Observation::dissipated},
      ObservableColumn{"deepest overlap", "mm", 1e3, &Observation::penetration_max},
  };
  return columns;
}

}  // namespace ballast
