#pragma once
// Three loops on dense column-major blocks, from which a factorisation without pivoting is made.
//
// They replace the BLAS: Debian's serial OpenBLAS may not be called by two threads at once, and its
// bits depend on the processor. Here every entry is one sum in one order, without fused
// multiply-add, so that the bits are the same on every instruction set.

#include <vector>

namespace ballast {

/// C -= A B. A is m x k, B is k x n; strides are distances between columns. C overlaps neither.
void subtract_product(int m, int n, int k, const double* a, int stride_a, const double* b,
                      int stride_b, double* c, int stride_c);

/// B := L^-1 B with L unit lower triangular, m x m, and read only below the diagonal; B is m x n.
void solve_unit_lower(int m, int n, const double* l, int stride_l, double* b, int stride_b);

/// Factors the first `columns` columns of A, rows x columns with columns <= rows, in place: U on
/// and above the diagonal, the unit lower L below it. Pivots are not checked.
void factor_columns(double* a, int stride, int rows, int columns);

/// The inner loops for one instruction set. All give the same bits.
struct DenseKernels {
  const char* instruction_set;
  /// subtract_product()
  void (*product)(int m, int n, int k, const double* a, int stride_a, const double* b, int stride_b,
                  double* c, int stride_c);
  /// solve_unit_lower() of at most eight rows
  void (*solve)(int rows, int n, const double* l, int stride_l, double* b, int stride_b);
};

/// Returns the sets that this processor has; the first one is used.
std::vector<DenseKernels> dense_kernels();

}  // namespace ballast
