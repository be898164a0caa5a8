#pragma once
// The solid fraction rho of a run, and how it grows (paper, sec. 5, Eq. 4, Figs. 12 and 13).

#include <span>

#include "experiments/measure/wall_cycles.hpp"
#include "experiments/step/step_record.hpp"

namespace ballast {

/// Compaction is measured in the paper's window, from its time lag to the end of the run, and
/// within the same absolute time for all frequencies.
inline constexpr TimeWindow paper_window{0.2, 1e30};
inline constexpr TimeWindow common_window{0.4, 1.0};

struct Compaction {
  double initial = not_known;        ///< rho before the drive
  double reference = not_known;      ///< rho_0: at paper_window.begin
  double last = not_known;           ///< at the end of the run
  std::vector<double> gains;         ///< of each period that counts
  double gain = not_known;           ///< Delta rho_1: mean over them
  double relative_gain = not_known;  ///< Delta rho_1 / rho_0
  double rate = not_known;           ///< Eq. 4 over paper_window [1/s]
  double rate_common = not_known;    ///< Eq. 4 over common_window [1/s]
};

/// `initial`: rho before the drive, which no row holds. `frequency` of the load [Hz], `step` h [s];
/// where they are NaN there is neither gain nor rate. `steps` must not be empty.
Compaction compaction_of(std::span<const StepRecord> steps, std::span<const WallPeriod> periods,
                         double initial, double frequency, double step);

/// Eq. 4 over the whole periods within a window: (rho(t_b) - rho(t_a)) / (reference (t_b - t_a))
/// [1/s]; NaN where there is none.
double compaction_rate(std::span<const StepRecord> steps, double frequency, double step,
                       double reference, const TimeWindow& window);

}  // namespace ballast
