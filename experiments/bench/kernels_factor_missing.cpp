// Stands in for the factorisation's kernels where SuiteSparse is not used.

#include "experiments/bench/kernels.hpp"

namespace ballast {

void add_factor_kernels(const KernelProblem&, std::vector<Kernel>&) {}

}  // namespace ballast
