#pragma once
// The measured quantities of the paper, each defined once. Everything is a function of one run's
// record; means over seeds are in fits.hpp.
//
// clang-format off
//   Delta x_max            largest rise of x above its running minimum in a period; end of the active phase, sec. 3, Figs. 9-11
//   v_max                  largest inward velocity of the wall in a period; passive phase, sec. 4, Fig. 9
//   jamming position       least x after the rise, until the period's end; sec. 3
//   net contraction        x at the period's begin minus x at its end; Fig. 3
//   Delta rho_1            change of the solid fraction over a period, same phase of the load; sec. 5, Fig. 12
//   rho_0                  solid fraction at t = 0.2 s; sec. 5
//   compaction rate        (rho(t_b) - rho(t_a)) / (rho_0 (t_b - t_a)) over whole periods; Eq. 4, Fig. 13
//   dissipation            energy lost in contacts per period
//   Eq. 3's right side     m/(m + m_w) . m g/f_max . g/nu^2; Eq. 3, Fig. 11
// clang-format on
//
// Which periods: whole periods of the load (they begin with the load falling through its mean, when
// the packing is jammed) that begin at or after 0.3 s and not in the first period, and end by the
// window's end. The rule leaves 2 periods at 1 Hz (3 s), 3 at 5 Hz and 42 at 60 Hz (1 s).

#include <array>
#include <span>
#include <string>
#include <vector>

#include "experiments/measure/fits.hpp"
#include "experiments/measure/run_data.hpp"

namespace ballast {

/// Which part of a run counts [s].
struct TimeWindow {
  double begin = 0.3;
  double end = 1e30;
};
inline constexpr TimeWindow scaling_window{0.3, 1e30};
/// Compaction: the paper's (from its time lag to the end of the run), and the same absolute time
/// for all frequencies.
inline constexpr TimeWindow paper_window{0.2, 1e30};
inline constexpr TimeWindow common_window{0.4, 1.0};

/// The transient that is cut for a load of frequency nu [Hz]: 0.3 s, at least one period, rounded
/// up to whole periods by what is counted.
double transient_of(double frequency, const TimeWindow& window = scaling_window);

/// One run, in numbers. NaN: not measurable in it (too short, no such column).
struct Observation {
  // what was set
  double frequency = not_known, f_max = not_known, gravity = not_known;  ///< [Hz], [N], [m/s^2]
  double grain_mass = not_known, wall_mass = not_known;  ///< m of all grains, m_w [kg]
  double mean_grain_mass = not_known;                    ///< m of one grain [kg]
  double step = not_known;                               ///< h [s]
  // means over the periods that count
  int periods = 0;
  double rise = not_known, speed_in = not_known;     ///< Delta x_max [m], v_max [m/s]
  double jam_position = not_known, net = not_known;  ///< [m]; net > 0: contraction
  double gain = not_known;                           ///< Delta rho_1
  double dissipated = not_known;                     ///< per period [J]
  // of the run
  double solid_initial = not_known, solid_reference = not_known;  ///< rho before the drive; rho_0
  double rate = not_known,
         rate_common = not_known;  ///< Eq. 4 over paper_window and over common_window [1/s]
  double first_contraction = not_known, first_time90 = not_known;  ///< [m], [s]
  double error_mean = not_known;  ///< judge's rms error over g h, mean over the steps that count
  double penetration_max = not_known;   ///< [m]
  double seconds_per_step = not_known;  ///< wall clock of the phases, median over steps
  long steps = 0;

  double eq3() const;            ///< right side of Eq. 3 without C, m = all grains [m]
  double eq3_one_grain() const;  ///< the same with m = one grain in both places
};

/// Measures a run's record. `window`: of the periods that count.
Observation observe(std::span<const StepRecord> steps, const RunFacts& facts, double grains,
                    const TimeWindow& window = scaling_window);

/// Eq. 4 over the whole periods within a window; NaN where there is none.
double compaction_rate(std::span<const StepRecord> steps, double frequency, double step,
                       double reference, const TimeWindow& window);

/// The observables by name, for tables over solvers and settings.
struct ObservableColumn {
  const char* name;  ///< "Δx_max"
  const char* unit;  ///< that of `factor` times the value
  double factor;     ///< from SI
  double Observation::*value;
};
std::span<const ObservableColumn> observable_columns();

}  // namespace ballast
