#pragma once
// `ballast bench kernels`: the inner loops on their own, with Google Benchmark, beside the
// machine's limits.

#include <functional>
#include <string>
#include <vector>

#include "experiments/bench/kernel_problem.hpp"
#include "experiments/bench/measurement.hpp"

namespace ballast {

struct KernelBenchOptions {
  std::string filter;     ///< regular expression over names; empty: all
  double min_time = 0.1;  ///< CPU seconds of one repetition
  int repeats = 5;
  double streaming_MB =
      0.0;  ///< least size of the streaming sweep's records; 0: twice the last cache
};

/// Every kernel's CPU time per item in ns, medians over the repetitions. Throws MissingSolver where
/// the program was built without Google Benchmark, std::invalid_argument when the filter matches
/// nothing.
std::vector<Measurement> run_kernels(const KernelProblem& problem,
                                     const KernelBenchOptions& options, const MachineFacts& facts);

/// One kernel: `call` is timed, and does `items` items.
struct Kernel {
  std::string group, name, unit;  ///< unit: "ns/pair"
  double items = 1.0;
  std::function<void()> call;
};

/// The kernels of each room; what they work on lives in the closures.
void add_detection_kernels(std::vector<Kernel>& kernels);
void add_problem_kernels(const KernelProblem& problem, std::vector<Kernel>& kernels);
/// `streaming`: `problem` so often that its records are no more in any cache.
void add_sweep_kernels(const KernelProblem& problem, int streaming_copies,
                       std::vector<Kernel>& kernels);
void add_one_contact_kernels(std::vector<Kernel>& kernels);
/// Nothing where SuiteSparse is not used.
void add_factor_kernels(const KernelProblem& problem, std::vector<Kernel>& kernels);

}  // namespace ballast
