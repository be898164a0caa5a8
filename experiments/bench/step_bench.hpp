#pragma once
// The cost of a step. `ballast bench step` measures whole steps of the driven box by phase of the
// step, with counters; `ballast bench kernels` the inner loops of a step on their own; `ballast
// bench scaling` the cost per grain of packings of the same kind and growing size.

#include <filesystem>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "experiments/bench/measurement.hpp"
#include "experiments/run/run.hpp"

namespace ballast {

/// A scene with `grains`, and its deposited packing.
struct DepositedBox {
  Scene scene;
  Rain rain;
  Packing packing;
};

/// Resolves a scene. Throws Error where there is none, or it has no grains.
Scene bench_scene(const std::string& name, const std::vector<std::string>& overrides);

/// Takes the packing from `cache`, or deposits and keeps it (resumable). Throws Error: interrupted.
DepositedBox deposited_box(const Scene& scene, const std::filesystem::path& cache);

/// The driven box at the start of its first step.
PreparedRun driven_start(const DepositedBox& box);

/// The settled box, behind walls that stand still.
PreparedRun settled_start(DepositedBox box);

/// One kernel: `call` is timed, and processes `items` items.
struct Kernel {
  std::string group, name, unit;  ///< unit: "ns/contact"
  double items = 1.0;
  std::function<void()> call;
};

/// Kernels for detection, assembly, judge and sweep at the last of `steps` steps of the driven box.
/// Their closures own the data.
std::vector<Kernel> step_kernels(const DepositedBox& box, int steps);

struct KernelBenchOptions {
  std::string filter;     ///< a part of group/name; empty: all
  double min_time = 0.1;  ///< CPU seconds of one repetition
  int repeats = 5;
};

/// CPU time per item in ns. Throws std::invalid_argument when the filter matches no kernel.
std::vector<Measurement> run_kernels(const std::vector<Kernel>& kernels,
                                     const KernelBenchOptions& options);

/// One measured step. The record holds the wall clock by phase.
struct BenchStep {
  StepRecord record;
  DetectionCounters counters;
  double cpu_seconds = 0.0;  ///< of the process, all threads
};

/// Steps `start` `steps` times with the scene's settings and `threads`. Measures of a run that are
/// not part of the step (solid fraction, recording) are left out.
std::vector<BenchStep> measure_steps(Scene scene, PreparedRun start, long steps, int threads);

/// Medians and means by phase of the step, counters and accuracy; once for all steps and once for
/// those of each state of the wall (wall_state()). Group "<threads> threads, all".
std::vector<Measurement> step_measurements(const Scene& scene, const std::vector<BenchStep>& steps,
                                           int threads);

struct ScalingOptions {
  std::vector<int> grains;  ///< wanted; each becomes a multiple of the scene's grains
  std::vector<int> threads{1};
  int warm_up = 5, steps = 10;  ///< of each packing
};

/// The measurements on one packing with one number of threads: by phase ns per grain and step, wall
/// clock; memory beyond that which the process had before. Group "<threads> threads, <grains>
/// grains".
struct ScalingPoint {
  int threads = 1, nx = 1, ny = 1;
  double grains = 0.0;
  std::vector<Measurement> measured;

  /// The median of a measurement. NaN: not measured.
  double value(const std::string& name) const;
};

/// Numbers of tiles nx and ny: nx * ny is near grains / of_tile, as square as can be.
std::pair<int, int> tiles_for(long grains, int of_tile);

/// Measures boxes of tiles (tiled_scene()) that have about the wanted grains. Each is deposited and
/// then measured in child processes of at most a day, so that its memory is its own. `take` is
/// called with each result. Throws Error where a child fails: out of memory, out of time.
void measure_scaling(const Scene& tile, const std::filesystem::path& cache,
                     const ScalingOptions& options,
                     const std::function<void(const ScalingPoint&)>& take);

}  // namespace ballast
