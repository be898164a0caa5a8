#pragma once
// The driven wall (paper, sec. 3): its periods and phases, found in a record of steps, and the
// force with which the grains push back in each phase.
//
// The periods that count are whole periods of the load that begin at or after 0.3 s and not in the
// first period. A period begins where the load falls through its mean, when the packing is jammed.
// A run's page, plans and the paper's figures all use this rule for the transient. The paper's own
// time lag of the first contraction is 0.2 s, but the packing still settles then: with 0.3 s and a
// period, the fastest drives lose the same time and the slowest a whole period of it.
//
// The phases follow from the outward velocity v, which is taken from the record and smoothed;
// v_peak is its largest magnitude after the first transient.
//   jammed   the longest unbroken stretch of |v| <= 2 % of v_peak in a period that contains a load
//            above its mean (at the load's maximum itself a loose packing may still creep). The
//            bound is loose on purpose: the residual velocity and f_g - f = m_w dv/dt inside are
//            results of the solver, so they must not select the samples. A turning point (v = 0 at
//            the largest x) is not jammed: its load is low.
//   active   v > 0 elsewhere: the packing unloads and pushes the wall out.
//   passive  v < 0 elsewhere: the wall is pressed in.
//
// Two laws are fitted to the same samples of the active phase:
//
//   f_g = A exp(kappa xi)       xi: the wall's distance from where its stroke began; the paper's
//   f_g = a + w f(t)            grains that rub with a constant force F and are carried along
//
// The second law holds for a wall of mass m_w that carries grains of mass M, which push with F:
// (m_w + M) dv/dt = F - f, so f_g = f + m_w dv/dt = a + w f with w = M/(m_w + M), F = a/(1 - w).
// Where f_max is far above F, Eq. 2 then gives Eq. 3 with
//
//   C = (9/4 pi^2) (F/(m g))^2 (m + m_w)/(m_w + M)
//
// because the load near its minimum is f_max (omega t)^2/4: the stroke goes from F = f at
// t = -t_0 = -(2/omega) sqrt(F/f_max) to rest at 2 t_0, over (9/4) F t_0^2/(m_w + M).

#include <algorithm>
#include <cmath>
#include <span>
#include <vector>

#include "experiments/measure/curve_fit.hpp"
#include "experiments/step/step_record.hpp"

namespace ballast {

enum class WallPhase : unsigned char { none, active, passive, jammed };

/// The time cut off at the start for a load of `frequency` [Hz]: 0.3 s, at least one period [s].
double transient_end(double frequency);

/// The first sample later than t + h/4, where times grow; h/4 allows for the rounding of multiples
/// of h.
size_t first_after(std::span<const StepRecord> steps, double t, double h);

/// A velocity of at most this fraction of the fastest is slow.
inline constexpr double jammed_speed = 0.02;

/// "jammed", "active" or "passive" for the velocity of one step, without regard to its load: jammed
/// where it is slow relative to the `fastest` [m/s].
inline const char* wall_state(double velocity, double fastest) {
  if (std::abs(velocity) <= jammed_speed * fastest) return "jammed";
  return velocity > 0.0 ? "active" : "passive";
}

/// One whole period of the load, (begin, end], from one fall through its mean to the next.
struct WallPeriod {
  double begin = 0, end = 0;      ///< [s]
  size_t first = 0, last = 0;     ///< samples [first, last)
  double x_before = not_known;    ///< jamming position the rise starts from: running minimum [m]
  double yield_load = not_known;  ///< the load at x_before [N]: below it the packing gives way
  double x_peak = not_known;      ///< [m]
  double x_after = not_known;     ///< jamming position after the peak: least x until the end [m]
  size_t peak = 0;                ///< sample of x_peak
  double rise = not_known;        ///< Delta x_max: largest rise above the running minimum [m]
  double net = not_known;         ///< change of x over the period [m]; negative: contraction
  double speed_out = not_known;   ///< largest outward velocity [m/s]
  double speed_in = not_known;    ///< largest inward velocity, positive: the paper's v_max [m/s]
  double solid_fraction = not_known;  ///< mean over the period
  double jammed_share = not_known;    ///< jammed fraction of the period's samples
};

struct WallCycles {
  std::vector<double> force, velocity;  ///< f_g [N] and v [m/s], smoothed, one per step
  double smoothing = not_known;         ///< width used [s]
  size_t smoothing_samples = 0;         ///< the same in steps
  double v_peak = not_known;            ///< [m/s]
  std::vector<WallPhase> phase;     ///< one per step; none before the end of the first transient
  std::vector<WallPeriod> periods;  ///< those that count
  int jammed_periods = 0;           ///< periods in which a jammed stretch was found

  /// The last four periods, which Fig. 4 shows.
  std::span<const WallPeriod> loop() const {
    return std::span(periods).last(std::min<size_t>(periods.size(), 4));
  }
};

/// `frequency` of the load [Hz], `step` h [s]; both must be positive (std::invalid_argument).
/// `smoothing`: width of the low-pass on f_g and v [s], but at most 1/20 period. `periods` is empty
/// where no whole period follows the transient, and where periods are shorter than a step.
WallCycles wall_cycles(std::span<const StepRecord> steps, double frequency, double step,
                       double smoothing = 4e-3);

/// The jammed state where the load is above its mean (with the load below, the wall is about to
/// leave).
struct JammedState {
  long samples = 0;
  double share = not_known;  ///< jammed fraction of the samples with a phase, at any load
  double force_mean = not_known, force_p95 = not_known,
         force_max = not_known;                          ///< |f_g - f|/f_max per step, not smoothed
  double force_smooth = not_known;                       ///< mean |f_g - f|/f_max with f_g smoothed
  double speed_mean = not_known, speed_max = not_known;  ///< |v| [m/s], not smoothed
};
JammedState jammed_state(std::span<const StepRecord> steps, const WallCycles& cycles, double f_min,
                         double f_max);

/// The force of the grains over all periods that count. Samples lie between the fractions fit_from
/// and fit_to of a stroke, so far from the jam that the smoothing of f_g mixes in nothing of it.
struct ForceLaw {
  ExponentialFit active;            ///< against xi, wall moving out: [N], rate kappa [1/m]
  LineFit active_line;              ///< the same samples with a line, for comparison
  LineFit by_load;                  ///< the same samples against f: offset a [N], slope w
  LineFit passive;                  ///< against xi, wall moving in: [N], slope [N/m], negative
  double push = not_known;          ///< F [N]
  double carried_mass = not_known;  ///< M [kg]
  double prefactor = not_known;     ///< C by the theory
};
/// Masses m of all grains and m_w [kg], g [m/s^2]. `push`, `carried_mass` and `prefactor` are not
/// known where w is not in [0, 1). The default omits the transients at both ends of a stroke.
ForceLaw force_law(std::span<const StepRecord> steps, const WallCycles& cycles, double grain_mass,
                   double wall_mass, double gravity, double fit_from = 0.1, double fit_to = 0.9);

}  // namespace ballast
