#include "solvers/gauss_seidel/group_kernels.hpp"

#include "solvers/parts/one_contact.hpp"

namespace ballast {

extern const GroupKernels sse2_group_kernels;
#if defined(__x86_64__)
extern const GroupKernels avx2_group_kernels, avx512_group_kernels;
#endif

const std::vector<const GroupKernels*>& all_group_kernels() {
  static const std::vector<const GroupKernels*> found = [] {
    std::vector<const GroupKernels*> kernels;
#if defined(__x86_64__)
    // The widest first. All do the same operations on the same numbers, so that the choice affects
    // the time only.
    if (__builtin_cpu_supports("avx512f")) kernels.push_back(&avx512_group_kernels);
    if (__builtin_cpu_supports("avx2")) kernels.push_back(&avx2_group_kernels);
#endif
    kernels.push_back(&sse2_group_kernels);
    return kernels;
  }();
  return found;
}

const GroupKernels& group_kernels() { return *all_group_kernels().front(); }

double slip_root(double s2, double c1, double c2, double mu, double y, double t1, double t2) {
  double x = 0.0;
  slide({.s1 = 1.0, .s2 = s2, .c1 = c1, .c2 = c2, .mu = mu}, y, t1, t2, x);
  return x;
}

}  // namespace ballast
