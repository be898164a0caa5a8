// Compiled for avx2 (solvers/CMakeLists.txt).
#include "solvers/gauss_seidel/kernel_table.hpp"

namespace ballast {

const GroupKernels avx2_group_kernels = kernels_of<32, 4, 2>("avx2");

}  // namespace ballast
