#pragma once
// What one trajectory of a closed-loop comparison came to, in numbers: a row of the page's table
// and of live.csv.

#include <string>
#include <vector>

#include "experiments/compare/live.hpp"
#include "experiments/measure/run_data.hpp"

namespace ballast {

/// NaN: not known, or not there (no driven wall, no grains, no reference).
struct LiveRow {
  const Trajectory* trajectory;
  double error_mean = not_known,
         error_max = not_known;  ///< rms over contacts, over the velocity scale: over steps
  double missed = not_known;     ///< share of the steps above the tolerance
  double wall_x = not_known, force_mean = not_known, penetration_max = not_known;
  double kinetic_energy = not_known, energy_residual = not_known, solid_fraction = not_known;
  double iterations = not_known, ms_per_step = not_known, solve_ms_per_step = not_known;
  double distance = not_known;  ///< from the reference at the last frame [m]
};

std::vector<LiveRow> live_rows(const LiveComparison& comparison);

/// All rows; and every step's scalars of one trajectory, with all their digits.
std::string live_csv(const std::vector<LiveRow>& rows);
std::string steps_csv(const Trajectory& trajectory);

}  // namespace ballast
