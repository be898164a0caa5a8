// Compiled for sse2 (solvers/CMakeLists.txt).
#include "solvers/gauss_seidel/kernel_table.hpp"

namespace ballast {

const GroupKernels sse2_group_kernels = kernels_of<16, 2, 2>("sse2");

}  // namespace ballast
