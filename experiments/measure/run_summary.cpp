#include "experiments/measure/run_summary.hpp"

#include <algorithm>
#include <cmath>

#include "platform/text.hpp"
#include "solvers/solver_list.hpp"

namespace ballast {
namespace {

bool is_between(double x, double lo, double hi) { return x >= lo && x <= hi; }

void summarise_cost(std::span<const StepRecord> steps, RunSummary& summary) {
  summary.ms_per_step = 0.0;
  for (const StepColumn& phase : step_phases()) {
    summary.cost.push_back({phase.phase, 1e3 * statistics(record_column(steps, phase.value)).mean});
    summary.ms_per_step += summary.cost.back().ms_per_step;
  }
}

void summarise_accuracy(std::span<const StepRecord> steps, RunSummary& summary) {
  const double scale = summary.facts.velocity_scale;
  summary.error_rms = statistics(record_column(steps, &StepRecord::error_rms));
  summary.error_max = statistics(record_column(steps, &StepRecord::error_max));
  summary.error_mean_relative = summary.error_rms.mean / scale;
  summary.error_max_relative = summary.error_rms.max / scale;
  if (summary.facts.tolerance > 0.0)
    summary.missed = std::ranges::count_if(steps, [](const auto& s) { return !(s.solved > 0.0); });
  double points = 0.0, overlap = 0.0;
  for (const StepRecord& step : steps) {
    if (step.penetration_max > summary.penetration_max || std::isnan(summary.penetration_max)) {
      summary.penetration_max = step.penetration_max;
      summary.penetration_max_time = std::isnan(step.penetration_max) ? not_known : step.time;
    }
    if (!std::isfinite(step.penetration_mean)) continue;
    points += step.active_contacts;
    overlap += step.active_contacts * step.penetration_mean;
  }
  summary.penetration_mean = overlap / points;
}

/// A missing term makes the balance NaN: it is not silently left out.
EnergyBalance energy_balance(std::span<const StepRecord> steps) {
  // The first step gives its own residual, as no row has the kinetic energy before it.
  double residual = steps.front().energy_residual +
                    (steps.back().kinetic_energy - steps.front().kinetic_energy),
         works = 0.0, kinetic = 0.0, gained = 0.0;
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
  const double end = transient_end(frequency);
  FirstContraction contraction;
  std::vector<double> x;
  for (const StepRecord& step : steps)
    if (step.time <= end) x.push_back(step.wall_x);
  contraction.size = std::max(-statistics(x).min, 0.0);  // x begins at 0
  if (contraction.size == 0.0) return contraction;
  const auto nearly_there = std::ranges::find_if(
      steps, [&](const StepRecord& step) { return -step.wall_x >= 0.9 * contraction.size; });
  if (nearly_there != steps.end()) contraction.time90 = nearly_there->time;
  return contraction;
}

/// Eq. 4 over the whole periods within a window: (rho(t_b) - rho(t_a)) / (reference (t_b - t_a))
/// [1/s]; NaN where there is no whole period.
double compaction_rate(std::span<const StepRecord> steps, double frequency, double step,
                       double reference, const TimeWindow& window) {
  const double slack = 0.25 * step, end = std::min(window.end, steps.back().time);
  // Periods begin at multiples of 1 / nu: t_a is the first in the window, t_b the last.
  const double a = std::ceil((window.begin - slack) * frequency) / frequency,
               b = std::floor((end + slack) * frequency) / frequency;
  if (!(b > a + slack)) return not_known;
  const size_t first = first_after(steps, a, step), last = first_after(steps, b, step);
  if (first == 0 || last <= first) return not_known;
  return (steps[last - 1].solid_fraction - steps[first - 1].solid_fraction) / (reference * (b - a));
}

Compaction compaction_of(std::span<const StepRecord> steps, std::span<const WallPeriod> periods,
                         const RunFacts& facts) {
  Compaction compaction;
  compaction.has_wall_inside = std::ranges::any_of(
      steps, [&](const StepRecord& step) { return -step.wall_x > facts.volume_margin; });
  if (compaction.has_wall_inside) return compaction;
  compaction.last = steps.back().solid_fraction;
  const auto begin = std::ranges::find_if(steps, [&](const StepRecord& step) {
    return step.time >= paper_window.begin - 0.25 * facts.step;
  });
  if (begin != steps.end()) compaction.reference = begin->solid_fraction;
  // rho at the end of a period minus rho at its beginning: both are at the same phase of the load,
  // so that the swing within the period drops out; not known when the record lacks the beginning
  for (const WallPeriod& period : periods)
    compaction.gains.push_back(period.first == 0 ? not_known
                                                 : steps[period.last - 1].solid_fraction -
                                                       steps[period.first - 1].solid_fraction);
  compaction.gain = statistics(compaction.gains).mean;
  compaction.relative_gain = compaction.gain / compaction.reference;
  const auto rate = [&](const TimeWindow& window) {
    return compaction_rate(steps, facts.frequency, facts.step, compaction.reference, window);
  };
  compaction.rate = rate(paper_window);
  compaction.rate_common = rate({0.4, 1.0});
  compaction.rate_first = rate({0.2, 1.0});
  if (steps.back().time >= 1.5 - 0.25 * facts.step) compaction.rate_late = rate({0.5, 1.5});
  return compaction;
}

void summarise_wall(std::span<const StepRecord> steps, RunSummary& summary) {
  const RunFacts& facts = summary.facts;
  summary.wall = wall_cycles(steps, facts.frequency, facts.step);
  summary.jammed = jammed_state(steps, summary.wall, facts.f_min, facts.f_max);
  summary.contraction = first_contraction(steps, facts.frequency);
  const std::vector<WallPeriod>& periods = summary.wall.periods;
  summary.rise = statistics(values_of(periods, &WallPeriod::rise));
  summary.net = statistics(values_of(periods, &WallPeriod::net));
  summary.yield_load = statistics(values_of(periods, &WallPeriod::yield_load));
  summary.speed_in = statistics(values_of(periods, &WallPeriod::speed_in));
  summary.speed_out = statistics(values_of(periods, &WallPeriod::speed_out));
  summary.prefactor = summary.rise.mean / eq3_displacement(facts);
  summary.law = force_law(steps, summary.wall, facts.grain_mass, facts.wall_mass, facts.gravity);
  std::vector<double> errors;
  for (const StepRecord& step : steps)
    if (step.time > transient_end(facts.frequency)) errors.push_back(step.error_rms);
  summary.error_counted = statistics(errors).mean / facts.velocity_scale;
}

/// Whether overlaps, and energy that contacts gave, are visible: above 1 %.
bool overlaps(const RunSummary& run) {
  return run.penetration_max > 0.01 * run.facts.smallest_size;
}
bool gains(const RunSummary& run) { return run.energy.gained > 0.01 * run.energy.moved; }

std::string length_text(double metres) {
  const bool is_small = metres < 1e-3;
  const double value = (is_small ? 1e6 : 1e3) * metres;
  // from 100 on %g would write a power of ten
  return printed(value >= 99.5 ? "%.0f %s" : "%.2g %s", value, is_small ? "µm" : "mm");
}

std::string steps_words(const RunSummary& run) {
  const double scale = std::isfinite(run.facts.velocity_scale) ? run.facts.velocity_scale : 1.0;
  const char* unit = error_unit(run);
  std::string text = printed(
      "%ld of %ld steps did not reach the tolerance of %.3g %s: their error is %.2g %s in "
      "the mean of all steps, %.2g in the worst.",
      run.missed, run.steps, run.facts.tolerance, unit, run.error_rms.mean / scale, unit,
      run.error_rms.max / scale);
  for (const SolverEntry& entry : solver_list())
    if (entry.name == run.facts.solver && entry.law != ContactLaw::coulomb)
      return text + " " + run.facts.solver + " solves another law (" + name_of(entry.law) +
             ") than the one that it is judged by.";
  text += " More accurate and slower: --set solver.";
  // the clock has stopped the solver where iterations are left
  const bool is_by_clock =
      run.facts.seconds_most < 1e30 && run.iterations.max < run.facts.iterations_most;
  text += is_by_clock ? printed("max_seconds=%.3g", 5.0 * run.facts.seconds_most)
                      : printed("max_iterations=%.0f",  // a scene accepts 1e9
                                std::min(1e9, 5.0 * std::max(1.0, run.facts.iterations_most)));
  if (run.facts.solver != "auto") text += ", or --set solver.name=auto";
  return text + ".";
}

std::string overlap_words(const RunSummary& run) {
  return "The deepest overlap is " + length_text(run.penetration_max) +
         printed(" at t = %.3g s, %.2g %% of the smallest body's radius. ",
                 run.penetration_max_time, 100.0 * run.penetration_max / run.facts.smallest_size) +
         (run.penetration_max_time < 1.5 * run.facts.step
              ? "Bodies begin inside one another: the scene is to be mended."
          : run.penetration_max < 1.5 * run.facts.slop
              ? "correction.slop leaves that much alone: a smaller one mends it."
          : run.missed > 0 ? "A smaller error of the steps mends it, or a smaller scene.step."
                           : "A smaller scene.step mends it.");
}

std::string energy_words(const RunSummary& run) {
  return printed(
             "Energy +%.3g J: contacts gave it to the bodies, which no law of contact does "
             "(%.2g %% of the energy that moved). ",
             run.energy.gained, 100.0 * run.energy.gained / run.energy.moved) +
         (run.facts.solver != "auto" ? "--set solver.name=auto mends it, or more iterations."
                                     : "More solver.max_iterations mend it.");
}

}  // namespace

std::vector<Displacement> period_displacements(std::span<const MotionState> frames,
                                               const RunSummary& summary) {
  const auto frame_at = [&](double time) {
    return std::find_if(frames.begin(), frames.end(), [&](const MotionState& frame) {
      return std::abs(frame.time - time) < 0.6 * summary.facts.step;
    });
  };
  std::vector<Displacement> all;
  for (const WallPeriod& period : summary.wall.periods) {
    const auto begin = frame_at(period.begin), end = frame_at(period.end);
    if (begin == frames.end() || end == frames.end()) continue;
    for (size_t b = 0; b < static_cast<size_t>(summary.facts.grains); ++b) {
      const Vec3 &from = begin->pose[b].position, &to = end->pose[b].position;
      all.push_back({0.5 * (from + to), to - from});
    }
  }
  return all;
}

double Roll::side_ratio() const {
  double weakest = not_known, strongest = 0.0;
  for (const double side : along) {
    const double with = circulation < 0.0 ? -side : side;
    weakest = std::fmin(weakest, with);
    strongest = std::max(strongest, std::abs(side));
  }
  return std::isnan(circulation) || !(strongest > 0.0) ? not_known : weakest / strongest;
}

Roll roll_of(std::span<const Displacement> displacements, const XzRectangle& r, double reach) {
  std::array<double, 4> sum{}, count{};
  const auto add = [&](size_t side, bool is_near, double along) {
    if (!is_near) return;
    sum[side] += along;
    count[side] += 1.0;
  };
  // a grain near a corner counts for both sides
  for (const Displacement& d : displacements) {
    const double x = d.place.x(), z = d.place.z();
    const bool in_x = is_between(x, r.x_lo, r.x_hi), in_z = is_between(z, r.z_lo, r.z_hi);
    add(0, in_x && std::abs(z - r.z_hi) <= reach, d.move.x());
    add(1, in_z && std::abs(x - r.x_hi) <= reach, -d.move.z());
    add(2, in_x && std::abs(z - r.z_lo) <= reach, -d.move.x());
    add(3, in_z && std::abs(x - r.x_lo) <= reach, d.move.z());
  }
  Roll roll;
  if (*std::min_element(count.begin(), count.end()) == 0.0) return roll;
  for (size_t side = 0; side < 4; ++side) roll.along[side] = sum[side] / count[side];
  roll.circulation = (roll.along[0] + roll.along[2]) * (r.x_hi - r.x_lo) +
                     (roll.along[1] + roll.along[3]) * (r.z_hi - r.z_lo);
  return roll;
}

std::vector<Displacement> cell_means(std::span<const Displacement> displacements,
                                     const XzRectangle& r, int columns, int rows) {
  std::vector<Vec3> sum(columns * rows, Vec3::Zero());
  std::vector<double> count(columns * rows, 0.0);
  const double width = (r.x_hi - r.x_lo) / columns, height = (r.z_hi - r.z_lo) / rows;
  for (const Displacement& d : displacements) {
    const double column = std::floor((d.place.x() - r.x_lo) / width),
                 row = std::floor((d.place.z() - r.z_lo) / height);
    if (!is_between(column, 0, columns - 1) || !is_between(row, 0, rows - 1)) continue;
    const auto cell = static_cast<size_t>(row * columns + column);
    sum[cell] += d.move;
    count[cell] += 1.0;
  }
  std::vector<Displacement> means;
  for (int cell = 0; cell < columns * rows; ++cell) {
    if (count[cell] == 0.0) continue;
    const int row = cell / columns, column = cell % columns;
    const double x = r.x_lo + (column + 0.5) * width, z = r.z_lo + (row + 0.5) * height;
    means.push_back({Vec3(x, 0.0, z), sum[cell] / count[cell]});
  }
  return means;
}

double eq3_displacement(const RunFacts& facts) {
  const double m = facts.grain_mass, g = facts.gravity;
  return m / (m + facts.wall_mass) * m * g / facts.f_max * g / (facts.frequency * facts.frequency);
}

Roll roll_of_periods(std::span<const MotionState> frames, const RunSummary& summary) {
  const RunFacts& facts = summary.facts;
  if (!(facts.grains > 0.0)) return {};
  const double length = facts.length, top = facts.height;
  return roll_of(period_displacements(frames, summary),
                 {0.25 * length, 0.75 * length, 0.25 * top, 0.75 * top}, facts.largest_size);
}

RunSummary summarise(std::span<const StepRecord> steps, const RunFacts& facts) {
  RunSummary summary;
  summary.facts = facts;
  summary.steps = static_cast<long>(steps.size());
  if (steps.empty()) return summary;
  summarise_cost(steps, summary);
  summary.duration = steps.back().time;
  summary.iterations = statistics(record_column(steps, &StepRecord::iterations));
  summary.contacts = statistics(record_column(steps, &StepRecord::contacts));
  summary.active_contacts = statistics(record_column(steps, &StepRecord::active_contacts));
  summarise_accuracy(steps, summary);
  summary.energy = energy_balance(steps);
  if (facts.has_wall && facts.frequency > 0.0 && facts.step > 0.0) summarise_wall(steps, summary);
  if (facts.has_packing) summary.compaction = compaction_of(steps, summary.wall.periods, facts);
  return summary;
}

const char* error_unit(const RunSummary& run) {
  const double scale = run.facts.velocity_scale;
  return std::isfinite(scale) && scale != 1.0 ? "g h" : "m/s";
}

bool has_no_findings(const RunSummary& run) {
  return run.missed == 0 && !overlaps(run) && !gains(run);
}

std::vector<std::string> run_findings(const RunSummary& run) {
  std::vector<std::string> words;
  if (run.missed > 0) words.push_back(steps_words(run));
  if (overlaps(run)) words.push_back(overlap_words(run));
  if (gains(run)) words.push_back(energy_words(run));
  if (words.empty())
    words.push_back((run.facts.tolerance > 0.0
                         ? printed("Every step reached the tolerance of %.3g %s",
                                   run.facts.tolerance, error_unit(run))
                         : "No step was asked for a tolerance") +
                    "; the deepest overlap is " + length_text(run.penetration_max) + ".");
  return words;
}

}  // namespace ballast
