#pragma once
// `ballast bench step`: whole steps of the driven box by phase of the step, with counters.

#include <vector>

#include "experiments/bench/bench_packing.hpp"
#include "experiments/bench/measurement.hpp"

namespace ballast {

/// One measured step. The record holds the wall clock by phase.
struct BenchStep {
  StepRecord record;
  DetectionCounters counters;
  double cpu_seconds = 0.0;  ///< of the process, all threads
};

/// Steps the start `steps` times with the scene's settings and `threads`. Measures of a run that
/// are not of the step (solid fraction, recording) are not in it.
std::vector<BenchStep> measure_steps(const Scene& scene, BenchStart start, long steps, int threads);

/// Medians and means by phase of the step, counters and accuracy; once for all steps and once for
/// those of each state of the wall (active: moves outward; passive: inward; jammed: slower than 2 %
/// of its fastest). Group "<threads> threads, all".
std::vector<Measurement> step_measurements(const Scene& scene, const std::vector<BenchStep>& steps,
                                           int threads);

/// Time of a step by phase over simulated time, in `windows` medians; the wall's velocity below.
Figure step_figure(const std::vector<BenchStep>& steps, int windows);

}  // namespace ballast
