// Compiled for avx512 (solvers/CMakeLists.txt).
#include "solvers/gauss_seidel/kernel_table.hpp"

namespace ballast {

const GroupKernels avx512_group_kernels = kernels_of<64, 2, 1>("avx512");

}  // namespace ballast
