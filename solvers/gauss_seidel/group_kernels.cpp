#include "solvers/gauss_seidel/group_kernels.hpp"

#include "solvers/parts/one_contact.hpp"

namespace ballast {

std::vector<const GroupKernels*> all_group_kernels() {
  std::vector<const GroupKernels*> kernels;
#if defined(__x86_64__)
  if (__builtin_cpu_supports("avx512f")) kernels.push_back(&avx512_group_kernels);
  if (__builtin_cpu_supports("avx2")) kernels.push_back(&avx2_group_kernels);
#endif
  kernels.push_back(&sse2_group_kernels);
  return kernels;
}

double slip_root(double s2, double c1, double c2, double mu, double y, double t1, double t2) {
  double x = 0.0;
  slide({.s1 = 1.0, .s2 = s2, .c1 = c1, .c2 = c2, .mu = mu}, y, t1, t2, x);
  return x;
}

}  // namespace ballast
