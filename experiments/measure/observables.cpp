#include "experiments/measure/observables.hpp"

#include <algorithm>
#include <cmath>

#include "experiments/step/record_column.hpp"

namespace ballast {
namespace {

/// Last sample at or before t (a quarter of a step for rounding); -1 when t is before the first.
long sample_at(std::span<const StepRecord> steps, double t, double h) {
  const auto later = std::find_if(steps.begin(), steps.end(),
                                  [&](const StepRecord& s) { return s.time > t + 0.25 * h; });
  return static_cast<long>(later - steps.begin()) - 1;
}

double mean_over(std::span<const WallPeriod> periods, double WallPeriod::*value) {
  std::vector<double> values;
  for (const WallPeriod& period : periods) values.push_back(period.*value);
  return statistics(values).mean;
}

/// rho at the end of a period minus rho at its begin.
double gain_of(std::span<const StepRecord> steps, const WallPeriod& period) {
  if (period.first == 0) return not_known;
  return steps[period.last - 1].solid_fraction - steps[period.first - 1].solid_fraction;
}

/// Wall clock: a machine that does something else for a while must not count.
double median_step_seconds(std::span<const StepRecord> steps) {
  std::vector<double> seconds;
  for (const StepRecord& step : steps) seconds.push_back(step_seconds(step));
  return quantile(seconds, 0.5);
}

double dissipated_in(std::span<const StepRecord> steps, const WallPeriod& period) {
  double sum = 0.0;
  for (size_t k = period.first; k < period.last; ++k) sum += steps[k].dissipated;
  return sum;
}

void measure_periods(std::span<const StepRecord> steps, std::span<const WallPeriod> periods,
                     Observation& seen) {
  seen.periods = static_cast<int>(periods.size());
  seen.rise = mean_over(periods, &WallPeriod::rise);
  seen.speed_in = mean_over(periods, &WallPeriod::speed_in);
  seen.jam_position = mean_over(periods, &WallPeriod::x_after);
  seen.net = -mean_over(periods, &WallPeriod::net);
  std::vector<double> gains, losses;
  for (const WallPeriod& period : periods) {
    gains.push_back(gain_of(steps, period));
    losses.push_back(dissipated_in(steps, period));
  }
  seen.gain = statistics(gains).mean;
  seen.dissipated = statistics(losses).mean;
}

}  // namespace

double transient_of(double frequency, const TimeWindow& window) {
  return std::max(window.begin, 1.0 / frequency);
}

double Observation::eq3() const {
  return grain_mass / (grain_mass + wall_mass) * grain_mass * gravity / f_max * gravity /
         (frequency * frequency);
}

double Observation::eq3_one_grain() const {
  return mean_grain_mass / (mean_grain_mass + wall_mass) * mean_grain_mass * gravity / f_max *
         gravity / (frequency * frequency);
}

double compaction_rate(std::span<const StepRecord> steps, double frequency, double step,
                       double reference, const TimeWindow& window) {
  if (steps.empty()) return not_known;
  const double slack = 0.25 * step, end = std::min(window.end, steps.back().time);
  const double a = std::ceil((window.begin - slack) * frequency) / frequency,
               b = std::floor((end + slack) * frequency) / frequency;
  const long first = sample_at(steps, a, step), last = sample_at(steps, b, step);
  if (!(b > a + slack) || first < 0 || last <= first) return not_known;
  return (steps[static_cast<size_t>(last)].solid_fraction -
          steps[static_cast<size_t>(first)].solid_fraction) /
         (reference * (b - a));
}

Observation observe(std::span<const StepRecord> steps, const RunFacts& given, double grains,
                    const TimeWindow& window) {
  const RunFacts facts = complete_facts(given, steps);
  Observation seen;
  seen.frequency = facts.frequency;
  seen.f_max = facts.f_max;
  seen.gravity = facts.gravity;
  seen.grain_mass = facts.grain_mass;
  seen.wall_mass = facts.wall_mass;
  seen.mean_grain_mass = facts.grain_mass / grains;
  seen.step = facts.step;
  seen.steps = static_cast<long>(steps.size());
  if (steps.empty() || !(facts.frequency > 0.0) || !(facts.step > 0.0)) return seen;

  WallSettings settings;
  settings.first_transient = transient_of(facts.frequency, window);
  const RunSummary summary = summarise(steps, facts, settings);
  std::vector<WallPeriod> periods;
  for (const WallPeriod& period : summary.wall.periods)
    if (period.end <= window.end + 0.25 * facts.step) periods.push_back(period);
  measure_periods(steps, periods, seen);

  seen.solid_initial = summary.compaction.initial;
  seen.solid_reference = summary.compaction.reference;
  seen.rate =
      compaction_rate(steps, facts.frequency, facts.step, seen.solid_reference, paper_window);
  seen.rate_common =
      compaction_rate(steps, facts.frequency, facts.step, seen.solid_reference, common_window);
  seen.first_contraction = summary.contraction.size;
  seen.first_time90 = summary.contraction.time90;
  std::vector<double> errors;
  for (const StepRecord& step : steps)
    if (step.time > settings.first_transient && step.time <= window.end + 0.25 * facts.step)
      errors.push_back(step.error_rms);
  seen.error_mean = statistics(errors).mean / facts.velocity_scale;
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
