#pragma once
// `ballast bench scaling`: the cost per grain of packings of the same kind and growing size.

#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "experiments/bench/bench_packing.hpp"
#include "experiments/bench/measurement.hpp"

namespace ballast {

struct ScalingOptions {
  std::vector<int> grains;  ///< wanted; what comes is the block's grains times a number of tiles
  std::vector<int> threads{1};
  int warm_up = 5, steps = 10;  ///< of each packing
  int sweeps = 10;              ///< timed on the last step's problem
  double tolerance = 1e-2;      ///< [g h] for the iterations needed
  int max_iterations = 300;
  std::vector<std::string> solvers{"pgs", "nncg"};
  double max_seconds = 3600.0;  ///< wall clock of one packing
};

/// What was measured on one packing with one number of threads: by phase ns per grain and step,
/// medians of wall clock; a sweep; memory beyond what the process had before; per solver what the
/// tolerance took. Group "<threads> threads, <grains> grains".
struct ScalingPoint {
  int threads = 1, nx = 1, ny = 1;
  double grains = 0.0;
  std::vector<Measurement> measured;

  /// NaN: not measured, or not reached.
  double value(const std::string& name) const;
};

/// Tiles nx * ny near grains / block, as square as can be.
std::pair<int, int> tiles_for(long grains, int block);

/// Each packing in a child process, so that its memory is its own. `said` hears of each. Throws
/// Error where a child fails: out of memory, out of time.
std::vector<ScalingPoint> measure_scaling(const DepositedBox& box, const ScalingOptions& options,
                                          const std::function<void(const ScalingPoint&)>& said);

/// ns per grain of detection, assembly and a sweep, and the iterations needed, over grains.
Figure scaling_figure(const ScalingOptions& options, const std::vector<ScalingPoint>& points);

}  // namespace ballast
