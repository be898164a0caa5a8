#pragma once
// `ballast bench kernels`: the inner loops of a step on their own.

#include <functional>
#include <string>
#include <vector>

#include "experiments/bench/bench_packing.hpp"
#include "experiments/bench/measurement.hpp"

namespace ballast {

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

}  // namespace ballast
