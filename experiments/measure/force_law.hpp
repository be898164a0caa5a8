#pragma once
// What the grains push back with while the wall moves: f_g against the wall's place, and against
// the load.
//
// Two laws for the same samples of the active phase (the wall moves out):
//
//   f_g = A exp(kappa xi)       xi: the wall's distance from where its stroke began; the paper's
//   f_g = a + w f(t)            grains that rub with a constant force F and are carried along
//
// The second: a wall of mass m_w that carries grains of mass M with it, which push with F, has
// (m_w + M) dv/dt = F - f, so f_g = f + m_w dv/dt = a + w f with w = M/(m_w + M), F = a/(1 - w).
// Where f_max is far above F, Eq. 2 then gives Eq. 3 with
//
//   C = (9/4 pi^2) (F/(m g))^2 (m + m_w)/(m_w + M)
//
// because the load near its minimum is f_max (omega t)^2/4: the stroke goes from F = f at
// t = -t_0 = -(2/omega) sqrt(F/f_max) to rest at 2 t_0, over (9/4) F t_0^2/(m_w + M).

#include <span>
#include <vector>

#include "experiments/measure/wall_cycles.hpp"

namespace ballast {

/// Samples of one phase of the strokes: between fit_from and fit_to of each, and so far from the
/// jam that the smoothing of f_g mixes nothing of it in.
struct StrokeSamples {
  std::vector<double> place;  ///< xi = x - x_before on the way out, x - x_after on the way back [m]
  std::vector<double> force;  ///< f_g, smoothed [N]
  std::vector<double> load;   ///< f(t) [N]
};
struct Strokes {
  StrokeSamples active, passive;
};
/// Of the periods [first, last) of `cycles`.
Strokes strokes_of(std::span<const StepRecord> steps, const WallCycles& cycles, size_t first,
                   size_t last, const WallSettings& settings = {});

/// The laws of Fig. 4 over the last periods together. The paper: exponential when active, linear
/// when passive.
struct LoopFits {
  ExponentialFit active;  ///< [N], rate [1/m]
  LineFit active_line;    ///< the same samples with a straight line, to see whether "exponential"
                          ///< says more
  LineFit passive;        ///< [N], slope [N/m]: negative, f_g grows as x decreases
};
LoopFits fit_loop(std::span<const StepRecord> steps, const WallCycles& cycles,
                  const WallSettings& settings = {});

/// Both laws over all periods that count.
struct ForceLaw {
  ExponentialFit by_place;          ///< [N], rate kappa [1/m]
  LineFit by_load;                  ///< offset a [N], slope w
  LineFit passive;                  ///< f_g against xi when the wall moves in: [N], [N/m]
  double push = not_known;          ///< F [N]
  double carried_mass = not_known;  ///< M [kg]
  double prefactor = not_known;     ///< C by the theory
};
/// m of all grains and m_w [kg], g [m/s^2]. `push`, `carried_mass` and `prefactor` are not known
/// where w is not within [0, 1).
ForceLaw force_law(std::span<const StepRecord> steps, const WallCycles& cycles, double grain_mass,
                   double wall_mass, double gravity, const WallSettings& settings = {});

}  // namespace ballast
