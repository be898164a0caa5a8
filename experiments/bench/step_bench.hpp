#pragma once
// What a step costs. `ballast bench step`: whole steps of the driven box by phase of the step, with
// counters. `ballast bench kernels`: the inner loops of a step on their own. `ballast bench
// scaling`: the cost per grain of packings of the same kind and growing size.

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

/// Throws Error: a scene without grains, or none.
Scene bench_scene(const std::string& name, const std::vector<std::string>& overrides);

/// From `cache`, or deposited now and kept there (resumable). Throws Error: interrupted.
DepositedBox deposited_box(const Scene& scene, const std::filesystem::path& cache);

/// The driven box at its first step.
PreparedRun driven_start(const DepositedBox& box);

/// The box as it has settled, behind walls that stand still.
PreparedRun settled_start(DepositedBox box);

/// One kernel: `call` is timed, and does `items` items.
struct Kernel {
  std::string group, name, unit;  ///< unit: "ns/contact"
  double items = 1.0;
  std::function<void()> call;
};

/// Detection, assembly, judge and sweep at the last of `steps` steps of the driven box. What they
/// work on lives in the closures.
std::vector<Kernel> step_kernels(const DepositedBox& box, int steps);

struct KernelBenchOptions {
  std::string filter;     ///< a part of group/name; empty: all
  double min_time = 0.1;  ///< CPU seconds of one repetition
  int repeats = 5;
};

/// CPU time per item in ns. Throws std::invalid_argument when the filter fits no kernel.
std::vector<Measurement> run_kernels(const std::vector<Kernel>& kernels,
                                     const KernelBenchOptions& options);

/// One measured step. The record holds the wall clock by phase.
struct BenchStep {
  StepRecord record;
  DetectionCounters counters;
  double cpu_seconds = 0.0;  ///< of the process, all threads
};

/// Steps the start `steps` times with the scene's settings and `threads`. Measures of a run that
/// are not of the step (solid fraction, recording) are not in it.
std::vector<BenchStep> measure_steps(const Scene& scene, PreparedRun start, long steps,
                                     int threads);

/// Medians and means by phase of the step, counters and accuracy; once for all steps and once for
/// those of each state of the wall (active: moves outward; passive: inward; jammed: slower than 2 %
/// of its fastest). Group "<threads> threads, all".
std::vector<Measurement> step_measurements(const Scene& scene, const std::vector<BenchStep>& steps,
                                           int threads);

struct ScalingOptions {
  std::vector<int> grains;  ///< wanted; what comes is the scene's grains times a number of tiles
  std::vector<int> threads{1};
  int warm_up = 5, steps = 10;  ///< of each packing
};

/// What was measured on one packing with one number of threads: by phase ns per grain and step,
/// wall clock; memory beyond what the process had before. Group "<threads> threads, <grains>
/// grains".
struct ScalingPoint {
  int threads = 1, nx = 1, ny = 1;
  double grains = 0.0;
  std::vector<Measurement> measured;

  /// The median. NaN: not measured.
  double value(const std::string& name) const;
};

/// Tiles nx * ny near grains / of_tile, as square as can be.
std::pair<int, int> tiles_for(long grains, int of_tile);

/// Boxes of as many tiles (tiled_scene()) as have about the wanted grains, each
/// deposited and then measured in child processes of at most a day, so that its memory is its own.
/// `said` hears of each. Throws Error where a child fails: out of memory, out of time.
std::vector<ScalingPoint> measure_scaling(const Scene& tile, const std::filesystem::path& cache,
                                          const ScalingOptions& options,
                                          const std::function<void(const ScalingPoint&)>& said);

}  // namespace ballast
