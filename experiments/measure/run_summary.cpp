#include "experiments/measure/run_summary.hpp"

#include <algorithm>
#include <cmath>

namespace ballast {
namespace {

bool is_any_nonzero(std::span<const StepRecord> steps, double StepRecord::*value) {
  return std::any_of(steps.begin(), steps.end(), [&](const StepRecord& s) {
    return std::isfinite(s.*value) && s.*value != 0.0;
  });
}

void summarise_cost(std::span<const StepRecord> steps, RunSummary& summary) {
  for (const StepColumn& phase : step_phases()) summary.cost.push_back({phase.phase, phase.value});
  for (PhaseCost& phase : summary.cost) {
    phase.ms_per_step = 1e3 * statistics(record_column(steps, phase.seconds)).mean;
    // phases that the record lacks are left out of the sum
    if (std::isfinite(phase.ms_per_step))
      summary.ms_per_step =
          phase.ms_per_step + (std::isnan(summary.ms_per_step) ? 0.0 : summary.ms_per_step);
  }
  if (summary.ms_per_step > 0.0)
    for (PhaseCost& phase : summary.cost) phase.share = phase.ms_per_step / summary.ms_per_step;
}

void summarise_accuracy(std::span<const StepRecord> steps, RunSummary& summary) {
  const double scale = summary.facts.velocity_scale;
  summary.error_rms = statistics(record_column(steps, &StepRecord::error_rms));
  summary.error_max = statistics(record_column(steps, &StepRecord::error_max));
  summary.error_mean_relative = summary.error_rms.mean / scale;
  summary.error_max_relative = summary.error_rms.max / scale;
  // A record without the column `solved` has the error alone to judge by.
  const double asked = summary.facts.tolerance * (std::isfinite(scale) ? scale : 1.0);
  for (const StepRecord& step : steps)
    if (asked > 0.0 && (std::isnan(step.solved) ? !(step.error_rms <= asked) : step.solved == 0.0))
      ++summary.missed;
  // the deepest overlap and when it was
  summary.penetration_mean = statistics(record_column(steps, &StepRecord::penetration_mean)).mean;
  for (const StepRecord& step : steps)
    if (step.penetration_max > summary.penetration_max || std::isnan(summary.penetration_max)) {
      summary.penetration_max = step.penetration_max;
      summary.penetration_max_time = std::isnan(step.penetration_max) ? not_known : step.time;
    }
}

/// A missing term makes the balance NaN: it is not silently left out.
EnergyBalance energy_balance(std::span<const StepRecord> steps) {
  // summed from the second step on, as the first kinetic energy is that after the first step
  double residual = steps.back().kinetic_energy - steps.front().kinetic_energy, works = 0.0,
         kinetic = 0.0, gained = 0.0;
  for (size_t k = 0; k < steps.size(); ++k) {
    kinetic = std::fmax(kinetic, steps[k].kinetic_energy);
    gained += steps[k].energy_gained;
    const double work = steps[k].work_load + steps[k].work_gravity + steps[k].work_prescribed;
    works += std::abs(work);
    if (k > 0) residual += steps[k].dissipated - work;
  }
  return {residual, works > 0.0 ? std::abs(residual) / works : not_known, gained, works + kinetic};
}

FirstContraction first_contraction(std::span<const StepRecord> steps, double frequency) {
  // within the first period the wall is pressed in once; 0.3 s for fast loads
  const double end = std::max(1.0 / frequency, 0.3);
  FirstContraction contraction;
  std::vector<double> x;
  for (const StepRecord& step : steps)
    if (step.time <= end) x.push_back(step.wall_x);
  contraction.size = -statistics(x).min;
  // the first time that it is nearly there
  for (const StepRecord& step : steps)
    if (-step.wall_x >= 0.9 * contraction.size) {
      contraction.time90 = step.time;
      break;
    }
  return contraction;
}

Statistics over_periods(const std::vector<WallPeriod>& periods, double WallPeriod::*value) {
  std::vector<double> values;
  for (const WallPeriod& period : periods) values.push_back(period.*value);
  return statistics(values);
}

/// Mean of the judge's rms error after the transient, in units of the velocity scale.
double error_after_transient(std::span<const StepRecord> steps, const RunFacts& facts) {
  std::vector<double> errors;
  for (const StepRecord& step : steps)
    if (step.time > transient_of(facts.frequency)) errors.push_back(step.error_rms);
  return statistics(errors).mean / facts.velocity_scale;
}

/// Last sample at or before t (a quarter of a step for rounding); -1 when t is before the first.
long sample_at(std::span<const StepRecord> steps, double t, double h) {
  const auto later = std::find_if(steps.begin(), steps.end(),
                                  [&](const StepRecord& s) { return s.time > t + 0.25 * h; });
  return static_cast<long>(later - steps.begin()) - 1;
}

/// rho at the end of a period minus rho at its begin: both at the same phase of the load, so that
/// the swing within the period drops out. NaN when the begin is not in the record.
double gain_of(std::span<const StepRecord> steps, const WallPeriod& period) {
  if (period.first == 0) return not_known;
  return steps[period.last - 1].solid_fraction - steps[period.first - 1].solid_fraction;
}

/// Eq. 4 over the whole periods within a window: (rho(t_b) - rho(t_a)) / (reference (t_b - t_a))
/// [1/s]; NaN where there is none.
double compaction_rate(std::span<const StepRecord> steps, double frequency, double step,
                       double reference, const TimeWindow& window) {
  // from the first begin of a period in the window to the last end of one
  const double slack = 0.25 * step, end = std::min(window.end, steps.back().time);
  // Periods begin at multiples of 1 / nu: the first one not before a, the last one not after b.
  const double a = std::ceil((window.begin - slack) * frequency) / frequency,
               b = std::floor((end + slack) * frequency) / frequency;
  if (!(b > a + slack)) return not_known;
  const long first = sample_at(steps, a, step), last = sample_at(steps, b, step);
  if (first < 0 || last <= first) return not_known;
  return (steps[static_cast<size_t>(last)].solid_fraction -
          steps[static_cast<size_t>(first)].solid_fraction) /
         (reference * (b - a));
}

Compaction compaction_of(std::span<const StepRecord> steps, std::span<const WallPeriod> periods,
                         const RunFacts& facts) {
  Compaction compaction;
  compaction.initial = facts.solid_fraction_initial;
  compaction.last = steps.back().solid_fraction;
  // The reference is the solid fraction where the paper's window begins.
  for (const StepRecord& row : steps)
    if (row.time >= paper_window.begin - 0.25 * facts.step) {
      compaction.reference = row.solid_fraction;
      break;
    }
  for (const WallPeriod& period : periods) compaction.gains.push_back(gain_of(steps, period));
  compaction.gain = statistics(compaction.gains).mean;
  compaction.relative_gain = compaction.gain / compaction.reference;
  const auto rate = [&](const TimeWindow& window) {
    return compaction_rate(steps, facts.frequency, facts.step, compaction.reference, window);
  };
  compaction.rate = rate(paper_window);
  compaction.rate_common = rate(common_window);
  return compaction;
}

void summarise_wall(std::span<const StepRecord> steps, const WallSettings& settings,
                    RunSummary& summary) {
  const RunFacts& facts = summary.facts;
  summary.wall = wall_cycles(steps, facts.frequency, facts.step, settings);
  summary.jammed = jammed_state(steps, summary.wall, facts.f_min, facts.f_max);
  summary.contraction = first_contraction(steps, facts.frequency);
  const std::vector<WallPeriod>& periods = summary.wall.periods;
  summary.periods = static_cast<long>(periods.size());
  summary.rise = over_periods(periods, &WallPeriod::rise);
  summary.net = over_periods(periods, &WallPeriod::net);
  summary.net_contraction = -summary.net.mean;
  summary.speed_in = over_periods(periods, &WallPeriod::speed_in);
  summary.speed_out = over_periods(periods, &WallPeriod::speed_out);
  summary.prefactor = summary.rise.mean / eq3_displacement(facts);
  summary.law =
      force_law(steps, summary.wall, facts.grain_mass, facts.wall_mass, facts.gravity, settings);
  summary.error_counted = error_after_transient(steps, facts);
}

}  // namespace

double eq3_displacement(const RunFacts& facts) {
  // Eq. 3 of the paper: m / (m + m_w) (m g / f_max) g / nu^2, m of all grains, m_w of the wall.
  const double m = facts.grain_mass, g = facts.gravity;
  return m / (m + facts.wall_mass) * m * g / facts.f_max * g / (facts.frequency * facts.frequency);
}

RunFacts complete_facts(RunFacts facts, std::span<const StepRecord> steps) {
  // what is given stays, whatever the record says
  const auto fill = [](double& value, double found) {
    if (!std::isfinite(value)) value = found;
  };
  if (steps.size() > 1)
    fill(facts.step,
         (steps.back().time - steps.front().time) / static_cast<double>(steps.size() - 1));
  fill(facts.velocity_scale, facts.gravity > 0.0    ? facts.gravity * facts.step
                             : facts.gravity == 0.0 ? 1.0
                                                    : not_known);
  if (!facts.has_wall) facts.has_wall = is_any_nonzero(steps, &StepRecord::load);
  if (!facts.has_packing) facts.has_packing = is_any_nonzero(steps, &StepRecord::solid_fraction);
  if (*facts.has_wall) {
    const Statistics load = statistics(record_column(steps, &StepRecord::load));
    fill(facts.f_max, load.max);
    fill(facts.f_min, load.min);
  }
  if (*facts.has_packing && !steps.empty())
    fill(facts.solid_fraction_initial, steps.front().solid_fraction);
  return facts;
}

Roll roll_of_periods(std::span<const MotionState> frames, const RunSummary& summary) {
  const RunFacts& facts = summary.facts;
  if (!(facts.grains > 0.0)) return {};
  const double length = facts.length, top = facts.height;
  return roll_of(period_displacements(frames, summary.wall.periods, facts.step,
                                      static_cast<size_t>(facts.grains)),
                 {0.25 * length, 0.75 * length, 0.25 * top, 0.75 * top}, facts.largest_size);
}

RunSummary summarise(std::span<const StepRecord> steps, const RunFacts& given,
                     const WallSettings& settings) {
  RunSummary summary;
  summary.facts = complete_facts(given, steps);
  summary.steps = static_cast<long>(steps.size());
  summarise_cost(steps, summary);
  if (steps.empty()) return summary;
  summary.duration = steps.back().time;
  // what every run has: effort, errors, overlaps, energy
  summary.iterations = statistics(record_column(steps, &StepRecord::iterations));
  summary.contacts = statistics(record_column(steps, &StepRecord::contacts));
  summary.active_contacts = statistics(record_column(steps, &StepRecord::active_contacts));
  summarise_accuracy(steps, summary);
  summary.energy = energy_balance(steps);
  // what a driven wall and a packing have besides
  if (*summary.facts.has_wall && summary.facts.frequency > 0.0 && summary.facts.step > 0.0)
    summarise_wall(steps, settings, summary);
  if (*summary.facts.has_packing)
    summary.compaction = compaction_of(steps, summary.wall.periods, summary.facts);
  return summary;
}

}  // namespace ballast
