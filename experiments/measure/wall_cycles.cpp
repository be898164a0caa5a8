#include "experiments/measure/wall_cycles.hpp"

#include <numbers>
#include <stdexcept>

namespace ballast {
namespace {

/// Finds the largest rise above the running minimum, and the position to which the wall returns.
/// NaN samples are skipped.
void find_stroke(std::span<const StepRecord> steps, WallPeriod& period) {
  // One period of x, outwards drawn upwards:
  //
  //     \          __ x_peak
  //      \        /  \      rise = x_peak - x_before
  //       \      /    \___ x_after
  //        \____/
  //          x_before, the least x so far
  double running = not_known;
  size_t jammed = period.first;
  for (size_t k = period.first; k < period.last; ++k) {
    const double x = steps[k].wall_x;
    if (!std::isfinite(x)) continue;
    if (!(running < x)) {  // the last of equal ones: there the stroke begins
      running = x;
      jammed = k;
    }
    if (x - running <= period.rise) continue;  // false at first: rise is NaN
    period.rise = x - running;
    period.peak = k;
    period.x_before = running;
    period.yield_load = steps[jammed].load;
    period.x_peak = x;
  }
  period.x_after = period.x_peak;
  for (size_t k = period.peak; k < period.last; ++k)
    if (steps[k].wall_x < period.x_after) period.x_after = steps[k].wall_x;
}

WallPeriod make_period(std::span<const StepRecord> steps, double begin, double end, double h) {
  WallPeriod period{begin, end, first_after(steps, begin, h), first_after(steps, end, h)};
  if (period.first == period.last) return period;
  find_stroke(steps, period);
  // the sample before the period is at its beginning; the first one is already a step later
  const size_t start = period.first > 0 ? period.first - 1 : period.first;
  period.net = steps[period.last - 1].wall_x - steps[start].wall_x;
  const auto within = steps.subspan(period.first, period.last - period.first);
  const Statistics speeds = statistics(record_column(within, &StepRecord::wall_v));
  period.speed_out = speeds.max;
  period.speed_in = -speeds.min;
  period.solid_fraction = statistics(record_column(within, &StepRecord::solid_fraction)).mean;
  return period;
}

/// Marks the longest stretch of |v| <= limit, `least` samples or more, from sample `first` on, that
/// contains a load above the mean of the period. Returns false when there is none.
bool mark_jammed(std::span<const StepRecord> steps, const WallPeriod& period, double limit,
                 size_t least, size_t first, WallCycles& cycles) {
  double mean = 0.0;
  for (size_t k = period.first; k < period.last; ++k)
    mean += steps[k].load / (period.last - period.first);
  const auto is_slow = [&](size_t k) { return std::abs(cycles.velocity[k]) <= limit; };
  size_t longest_begin = 0, longest_end = 0;
  for (size_t k = period.first; k < period.last; ++k) {
    if (!is_slow(k) || !(steps[k].load > mean)) continue;
    size_t begin = k, end = k + 1;  // it may reach beyond the period
    while (begin > first && is_slow(begin - 1)) --begin;
    while (end < steps.size() && is_slow(end)) ++end;
    if (end - begin >= least && end - begin > longest_end - longest_begin) {
      longest_begin = begin;
      longest_end = end;
    }
    k = end;
  }
  for (size_t k = std::max(longest_begin, first); k < longest_end; ++k)
    cycles.phase[k] = WallPhase::jammed;
  return longest_end > longest_begin;
}

void find_phases(std::span<const StepRecord> steps, double duration_of_period, double h,
                 WallCycles& cycles) {
  const double transient = transient_end(1.0 / duration_of_period);
  const size_t first = first_after(steps, transient, h);
  const auto moving = std::span(cycles.velocity).subspan(first);
  cycles.v_peak =
      statistics(values_of(moving, [](double velocity) { return std::abs(velocity); })).max;
  const double limit = jammed_speed * cycles.v_peak;
  // a slow stretch of less than 4 % of a period is a turning point
  const size_t least = static_cast<size_t>(0.04 * duration_of_period / h);
  bool has_moved = false;  // a wall at rest since the end of the transient has no phase yet,
                           // unless it is found to be jammed
  for (size_t k = first; k < steps.size(); ++k) {
    const double v = cycles.velocity[k];
    has_moved = has_moved || std::abs(v) > limit;
    if (has_moved)
      cycles.phase[k] = v > 0.0   ? WallPhase::active
                        : v < 0.0 ? WallPhase::passive
                                  : WallPhase::none;
  }
  // the jam before the first whole period reaches into it
  const double begin = cycles.periods.empty() ? 0.0 : cycles.periods.front().begin;
  if (begin >= duration_of_period - 0.25 * h)
    mark_jammed(steps, make_period(steps, begin - duration_of_period, begin, h), limit, least,
                first, cycles);
  // a jam replaces the phase active or passive that the sign of a residual velocity gave
  for (const WallPeriod& period : cycles.periods)
    if (mark_jammed(steps, period, limit, least, first, cycles)) ++cycles.jammed_periods;
  for (WallPeriod& period : cycles.periods) {
    const auto phases = std::span(cycles.phase).subspan(period.first, period.last - period.first);
    const double jammed = std::ranges::count(phases, WallPhase::jammed);
    period.jammed_share = jammed / phases.size();
  }
}

}  // namespace

double transient_end(double frequency) { return std::max(0.3, 1.0 / frequency); }

size_t first_after(std::span<const StepRecord> steps, double t, double h) {
  const auto later = std::ranges::partition_point(
      steps, [&](const StepRecord& s) { return !(s.time > t + 0.25 * h); });
  return static_cast<size_t>(later - steps.begin());
}

WallCycles wall_cycles(std::span<const StepRecord> steps, double frequency, double h,
                       double smoothing) {
  if (!(frequency > 0.0) || !(h > 0.0))
    throw std::invalid_argument("wall cycles need a positive frequency and step");
  const double duration_of_period = 1.0 / frequency;
  // The force of a single step is noise of the solver and of impacts: both curves are smoothed.
  WallCycles cycles;
  // No wider than a twentieth of a period: the stroke itself must not be smoothed away.
  cycles.smoothing = std::min(smoothing, duration_of_period / 20.0);
  const int width = static_cast<int>(std::lround(cycles.smoothing / h));
  cycles.smoothing_samples = static_cast<size_t>(width);
  cycles.force = low_pass(record_column(steps, &StepRecord::wall_force), width);
  cycles.velocity = low_pass(record_column(steps, &StepRecord::wall_v), width);
  cycles.phase.assign(steps.size(), WallPhase::none);
  if (steps.empty()) return cycles;
  const double transient = transient_end(frequency), end_time = steps.back().time;
  if (duration_of_period < h || transient > end_time) return cycles;

  // Period k begins at k/nu, where the load falls through its mean. A quarter of a step is allowed
  // for the rounding of times.
  for (long k = std::lround(std::ceil((transient - 0.25 * h) * frequency));; ++k) {
    const double begin = static_cast<double>(k) * duration_of_period;
    const double end = begin + duration_of_period;
    if (end > end_time + 0.25 * h) break;
    const WallPeriod period = make_period(steps, begin, end, h);
    if (period.first < period.last) cycles.periods.push_back(period);
  }
  find_phases(steps, duration_of_period, h, cycles);
  return cycles;
}

JammedState jammed_state(std::span<const StepRecord> steps, const WallCycles& cycles, double f_min,
                         double f_max) {
  std::vector<double> miss, smooth_miss, speed;
  long jammed = 0, all = 0;
  for (size_t k = 0; k < steps.size(); ++k) {
    if (cycles.phase[k] == WallPhase::none) continue;
    ++all;
    if (cycles.phase[k] != WallPhase::jammed) continue;
    ++jammed;
    if (steps[k].load < 0.5 * (f_min + f_max)) continue;
    miss.push_back(std::abs(steps[k].wall_force - steps[k].load) / f_max);
    smooth_miss.push_back(std::abs(cycles.force[k] - steps[k].load) / f_max);
    speed.push_back(std::abs(steps[k].wall_v));
  }
  const Statistics force = statistics(miss), speeds = statistics(speed);
  return {.samples = std::ssize(miss),
          .share = all > 0 ? static_cast<double>(jammed) / all : not_known,
          .force_mean = force.mean,
          .force_p95 = quantile(miss, 0.95),
          .force_max = force.max,
          .force_smooth = statistics(smooth_miss).mean,
          .speed_mean = speeds.mean,
          .speed_max = speeds.max};
}

ForceLaw force_law(std::span<const StepRecord> steps, const WallCycles& cycles, double grain_mass,
                   double wall_mass, double gravity, double fit_from, double fit_to) {
  struct Samples {
    std::vector<double> place, force, load;
  } active, passive;
  // nearer to the jam than the width of the smoothing, f_g contains some force of the jam
  const size_t width = cycles.smoothing_samples;
  for (const WallPeriod& period : cycles.periods)
    for (size_t k = period.first + width; k + width < period.last; ++k) {
      // xi is counted from x_before on the way out, from x_after on the way back
      const bool rises = k <= period.peak;
      const double from = rises ? period.x_before : period.x_after, stroke = period.x_peak - from,
                   xi = steps[k].wall_x - from;
      if (!(xi >= fit_from * stroke && xi <= fit_to * stroke)) continue;
      const WallPhase phase = rises ? WallPhase::active : WallPhase::passive;
      const size_t towards_jam = rises ? k - width : k + width;
      if (cycles.phase[k] != phase || cycles.phase[towards_jam] != phase) continue;
      Samples& samples = rises ? active : passive;
      samples.place.push_back(xi);
      samples.force.push_back(cycles.force[k]);
      samples.load.push_back(steps[k].load);
    }
  ForceLaw law{fit_exponential(active.place, active.force), fit_line(active.place, active.force),
               fit_line(active.load, active.force), fit_line(passive.place, passive.force)};
  const double w = law.by_load.slope;
  if (!(w >= 0.0 && w < 1.0)) return law;
  law.push = law.by_load.offset / (1.0 - w);
  law.carried_mass = wall_mass * w / (1.0 - w);
  const double part = law.push / (grain_mass * gravity);
  law.prefactor = 9.0 / (4.0 * std::numbers::pi * std::numbers::pi) * part * part *
                  (grain_mass + wall_mass) / (wall_mass + law.carried_mass);
  return law;
}

}  // namespace ballast
