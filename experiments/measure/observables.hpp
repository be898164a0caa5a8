#pragma once
// A run in a few numbers, for figures and tables over many runs. What each means, and how it is
// measured, is said in run_summary.hpp: these are the same numbers that the run's own page has.
// Means over seeds are in fits.hpp.

#include <span>

#include "experiments/measure/fits.hpp"
#include "experiments/measure/run_data.hpp"

namespace ballast {

/// One run, in numbers. NaN: not measurable in it (too short, no such column).
struct Observation {
  RunFacts facts;                      ///< what was set
  double mean_grain_mass = not_known;  ///< m of one grain [kg]
  // means over the periods that count
  int periods = 0;
  double rise = not_known, speed_in = not_known;       ///< Delta x_max [m], v_max [m/s]
  double net = not_known;                              ///< [m], > 0: contraction
  double gain = not_known, relative_gain = not_known;  ///< Delta rho_1; over rho_0
  double dissipated = not_known;                       ///< per period [J]
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
                    const TimeWindow& window = {});

/// The observables by name, for tables over solvers and settings.
struct ObservableColumn {
  const char* name;  ///< "Δx_max"
  const char* unit;  ///< that of `factor` times the value
  double factor;     ///< from SI
  double Observation::*value;
};
std::span<const ObservableColumn> observable_columns();

}  // namespace ballast
