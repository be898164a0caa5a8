#pragma once
// Lanes of numbers for the loops over a sweep's records: several products and sums at once.
// Included by the sources of this room alone.
//
// GCC's vector extensions: the same element-wise operations in the same order on every instruction
// set, hence the same bits (-ffp-contract=off keeps multiplications and additions apart).

#include "platform/for_each_cpu.hpp"
#include "solvers/gauss_seidel/lanes.hpp"

namespace ballast {

using Vector8 = double __attribute__((vector_size(64)));
using Vector4 = double __attribute__((vector_size(32)));

using Loose8 = double __attribute__((vector_size(64), aligned(8), may_alias));
using Loose4 = double __attribute__((vector_size(32), aligned(8), may_alias));
using Lanes4 = double __attribute__((vector_size(32), may_alias));
using Loose2 = double __attribute__((vector_size(16), aligned(8), may_alias));

BALLAST_INLINE Vector8 load8(const double* x) { return *reinterpret_cast<const Vector8*>(x); }
/// A row, and the two numbers that follow it (see FrictionRecord).
BALLAST_INLINE Vector8 load_row(const double* x) { return *reinterpret_cast<const Loose8*>(x); }
/// Zero in place of what follows a row.
BALLAST_INLINE Vector8 only_row(const Vector8& x) {
  using Bits = long long __attribute__((vector_size(64)));
  constexpr Bits keep = {-1, -1, -1, -1, -1, -1, 0, 0};
  return (Vector8)((Bits)x & keep);
}
BALLAST_INLINE void store_row(double* x, const Vector8& value) {
  *reinterpret_cast<Loose4*>(x) = __builtin_shufflevector(value, value, 0, 1, 2, 3);
  *reinterpret_cast<Loose2*>(x + 4) = __builtin_shufflevector(value, value, 4, 5);
}
BALLAST_INLINE void store8(double* x, const Vector8& value) {
  *reinterpret_cast<Vector8*>(x) = value;
}

BALLAST_INLINE Vector4 halves(const Vector8& x) {
  return __builtin_shufflevector(x, x, 0, 1, 2, 3) + __builtin_shufflevector(x, x, 4, 5, 6, 7);
}

/// The sums of three vectors' entries.
BALLAST_INLINE Vector4 three_sums(const Vector8& x, const Vector8& y, const Vector8& z) {
  const Vector4 p = halves(x), q = halves(y), s = halves(z);
  const Vector4 pq =
      __builtin_shufflevector(p, q, 0, 4, 2, 6) + __builtin_shufflevector(p, q, 1, 5, 3, 7);
  const Vector4 ss =
      __builtin_shufflevector(s, s, 0, 0, 2, 2) + __builtin_shufflevector(s, s, 1, 1, 3, 3);
  return __builtin_shufflevector(pq, ss, 0, 1, 4, 5) + __builtin_shufflevector(pq, ss, 2, 3, 6, 7);
}

/// G w over both sides. `rows[side][i]`: the rows of G, each followed by two finite numbers.
template <typename Rows>
BALLAST_INLINE Vector4 relative_velocity(const Rows& rows, const Vector8& wa, const Vector8& wb) {
  return three_sums(load_row(rows[0][0]) * wa + load_row(rows[1][0]) * wb,
                    load_row(rows[0][1]) * wa + load_row(rows[1][1]) * wb,
                    load_row(rows[0][2]) * wa + load_row(rows[1][2]) * wb);
}

/// Row i times row j, lane by lane, over both sides.
template <typename Rows>
BALLAST_INLINE Vector8 row_product(const Rows& rows, int i, int j) {
  return only_row(load_row(rows[0][i]) * load_row(rows[0][j]) +
                  load_row(rows[1][i]) * load_row(rows[1][j]));
}

}  // namespace ballast
