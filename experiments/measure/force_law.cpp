#include "experiments/measure/force_law.hpp"

#include <numbers>

namespace ballast {
namespace {

void add_sample(std::span<const StepRecord> steps, const WallCycles& cycles, size_t k, double place,
                StrokeSamples& samples) {
  samples.place.push_back(place);
  samples.force.push_back(cycles.force[k]);
  samples.load.push_back(steps[k].load);
}

}  // namespace

Strokes strokes_of(std::span<const StepRecord> steps, const WallCycles& cycles, size_t first,
                   size_t last, const WallSettings& settings) {
  Strokes strokes;
  for (size_t p = first; p < last; ++p) {
    const WallPeriod& period = cycles.periods[p];
    const auto is_fitted = [&](double xi, double stroke) {
      return xi >= settings.fit_from * stroke && xi <= settings.fit_to * stroke;
    };
    // Nearer to the jam than the smoothing is wide, f_g holds some of the jam's force.
    const size_t width = cycles.smoothing_samples;
    for (size_t k = period.first + width; k + width < period.last; ++k) {
      const bool rises = k <= period.peak;
      // The stroke is counted from where it began: x_before on the way out, x_after on the way
      // back.
      const double from = rises ? period.x_before : period.x_after, xi = steps[k].wall_x - from;
      if (!is_fitted(xi, period.x_peak - from)) continue;
      if (rises && cycles.phase[k] == WallPhase::active &&
          cycles.phase[k - width] == WallPhase::active)
        add_sample(steps, cycles, k, xi, strokes.active);
      else if (!rises && cycles.phase[k] == WallPhase::passive &&
               cycles.phase[k + width] == WallPhase::passive)
        add_sample(steps, cycles, k, xi, strokes.passive);
    }
  }
  return strokes;
}

LoopFits fit_loop(std::span<const StepRecord> steps, const WallCycles& cycles,
                  const WallSettings& settings) {
  const auto [active, passive] =
      strokes_of(steps, cycles, cycles.loop_first, cycles.loop_last, settings);
  return {fit_exponential(active.place, active.force), fit_line(active.place, active.force),
          fit_line(passive.place, passive.force)};
}

ForceLaw force_law(std::span<const StepRecord> steps, const WallCycles& cycles, double grain_mass,
                   double wall_mass, double gravity, const WallSettings& settings) {
  const auto [active, passive] = strokes_of(steps, cycles, 0, cycles.periods.size(), settings);
  ForceLaw law;
  law.by_place = fit_exponential(active.place, active.force);
  law.by_load = fit_line(active.load, active.force);
  law.passive = fit_line(passive.place, passive.force);
  // F, M and C by the theory of the header
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
