#pragma once
// The numbers of a run that the report and the figures of the paper state: pure functions of the
// record. NaN: not known.

#include <array>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "experiments/measure/curve_fit.hpp"
#include "experiments/measure/wall_cycles.hpp"
#include "experiments/step/step_record.hpp"

namespace ballast {

/// What the record's rows don't say. Whatever is NaN is either derived by complete_facts() or the
/// numbers that need it stay NaN.
struct RunFacts {
  double step = not_known;  ///< h [s]
  double velocity_scale =
      not_known;  ///< errors are quoted relative to this: g h, or 1 m/s without gravity [m/s]
  double gravity = not_known;                            ///< [m/s^2]
  double frequency = not_known;                          ///< nu of the load [Hz]
  double f_max = not_known, f_min = not_known;           ///< of the load [N]
  double grain_mass = not_known, wall_mass = not_known;  ///< m (all grains), m_w [kg]
  double solid_fraction_initial = not_known;             ///< before the drive
  std::optional<bool> has_wall, has_packing;             ///< a driven wall; a solid fraction
};

/// Fills in from the record what is missing: h from the times, f_max, f_min and frequency from the
/// load, the initial solid fraction from the first row, has_wall and has_packing from columns that
/// are not zero. velocity_scale = gravity * step when both are known.
RunFacts complete_facts(RunFacts facts, std::span<const StepRecord> steps);

/// What is asked of a run (docs: measures of the project), and what the paper says.
namespace target {
inline constexpr double error_mean =
    1e-3;                                  ///< rms natural map over velocity_scale, mean over steps
inline constexpr double error_max = 1e-2;  ///< the same, worst step
inline constexpr double penetration_max = 0.25e-3;  ///< [m]
inline constexpr double penetration_mean = 5e-6;    ///< [m]
inline constexpr double jammed_force = 1e-3;        ///< |f_g - f|/f_max
}  // namespace target
namespace paper {
inline constexpr double solid_fraction_initial = 0.50;
inline constexpr double solid_fraction_reference = 0.52;  ///< rho_0, after 0.2 s
inline constexpr double reference_time = 0.2;             ///< [s]
inline constexpr double gain_per_period = 0.0025;  ///< Delta rho_1 / rho_0 below nu_c (Eq. 5)
inline constexpr double prefactor = 0.01;          ///< C of Eq. 3
}  // namespace paper

/// Wall clock by phase of the step.
struct PhaseCost {
  const char* name;
  double StepRecord::*seconds;
  double ms_per_step = not_known;
  double share = not_known;  ///< of the sum of all phases
};

struct EnergyBalance {
  double work_load = not_known, work_gravity = not_known,
         work_prescribed = not_known;  ///< [J], sums over the run
  double dissipated = not_known, work_gyroscopic = not_known, work_correction = not_known;
  double kinetic_first = not_known,
         kinetic_last = not_known;  ///< after the first and after the last step
  double work_absolute =
      not_known;  ///< sum over steps of |works together|: what the residual is compared with
  double residual_recorded = not_known;  ///< sum of the column
  /// The same from the other columns, after the first step: K_end - K_1 - works + dissipation.
  double residual = not_known;
  double relative = not_known;  ///< |residual| / work_absolute
};

/// x falls at the start; least x within the first period, at least 0.3 s.
struct FirstContraction {
  double size = not_known;    ///< [m]
  double time90 = not_known;  ///< when 90 % of it is reached [s]
};

struct Compaction {
  double initial = not_known;    ///< before the drive
  double reference = not_known;  ///< rho_0: at 0.2 s
  double last = not_known;
  LineFit per_period;  ///< line through the period means against the period's number: slope = Delta
                       ///< rho_1
  double relative_gain = not_known;  ///< Delta rho_1 / rho_0
  double rate = not_known;           ///< Eq. 4: relative_gain * nu [1/s]
};

struct RunSummary {
  RunFacts facts;
  long steps = 0;
  double duration = not_known;  ///< [s]

  std::array<PhaseCost, 6> cost;
  double ms_per_step = not_known;  ///< sum of the phases
  Statistics iterations, contacts, active_contacts;

  Statistics error_rms, error_max;  ///< [m/s]
  double error_mean_relative = not_known,
         error_max_relative = not_known;   ///< of error_rms over velocity_scale: mean, worst step
  double error_worst_contact = not_known;  ///< of error_max over velocity_scale
  double above_target =
      not_known;  ///< share of steps with relative error_rms above target::error_mean

  double penetration_max = not_known;       ///< [m] in the whole run
  double penetration_max_time = not_known;  ///< [s]
  double penetration_mean =
      not_known;  ///< [m] mean over steps of the mean over active contact points

  EnergyBalance energy;

  // with a driven wall
  WallCycles wall;
  LoopFits loop;
  JammedState jammed;
  FirstContraction contraction;
  Statistics rise, net, speed_in, speed_out;  ///< over the whole periods after the first transient
  double prefactor = not_known;               ///< C of Eq. 3, m the mass of all grains

  // with a packing
  Compaction compaction;
};

RunSummary summarise(std::span<const StepRecord> steps, const RunFacts& facts,
                     const WallSettings& settings = {});

}  // namespace ballast
