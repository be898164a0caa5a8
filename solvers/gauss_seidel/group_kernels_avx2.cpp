// Compiled for avx2 (solvers/CMakeLists.txt).
#include "solvers/gauss_seidel/lanes_avx2.hpp"

#include "solvers/gauss_seidel/kernel_table.hpp"

namespace ballast {

extern const GroupKernels avx2_group_kernels;
const GroupKernels avx2_group_kernels = kernels_of<Lanes4d, 4, Lanes8s, 2>("avx2");

}  // namespace ballast
