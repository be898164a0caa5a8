// Stands in for the kernels' bench where Google Benchmark is not used.

#include "experiments/bench/kernels.hpp"
#include "solvers/solver_list.hpp"

namespace ballast {

std::vector<Measurement> run_kernels(const KernelProblem&, const KernelBenchOptions&,
                                     const MachineFacts&) {
  throw MissingSolver(
      "bench kernels: this program was built without Google Benchmark (libbenchmark-dev, "
      "BALLAST_BENCHMARK)");
}

}  // namespace ballast
