#pragma once
// The bodies of several contacts, from rows to lanes and back, in the pieces in which they will be
// loaded again: sixteen bytes, or what the instruction set has for whole rows. (A load larger than
// the store before it waits until that has reached the cache.)

#include "solvers/gauss_seidel/lanes.hpp"

namespace ballast {

/// Six numbers of the rows at `at[0]`, `at[1]`, ...: component k of all in c[k].
template <typename V>
BALLAST_INLINE void gather_bodies(const void* base, const int* at, V* c) {
  if constexpr (requires { gather_rows(base, at, c); }) {
    gather_rows(base, at, c);
  } else if constexpr (sizeof(typename V::Number) == 8) {
    for (int pair = 0; pair < 3; ++pair) {
      const void* part = at_offset(base, 16 * pair);
      const V even = collect<2, V>(part, at), odd = collect<2, V>(part, at + 1);
      c[2 * pair] = interleave_low(even, odd);
      c[2 * pair + 1] = interleave_high(even, odd);
    }
  } else {
    // Four rows are a square of four by four numbers: transposed in two steps.
    for (int part = 0; part < 2; ++part) {
      const void* from = at_offset(base, 16 * part);
      const V r0 = collect<4, V>(from, at), r1 = collect<4, V>(from, at + 1),
              r2 = collect<4, V>(from, at + 2), r3 = collect<4, V>(from, at + 3);
      const V low01 = interleave_low(r0, r1), low23 = interleave_low(r2, r3);
      c[4 * part] = halves_low(low01, low23);
      c[4 * part + 1] = halves_high(low01, low23);
      if (part == 1) break;
      const V high01 = interleave_high(r0, r1), high23 = interleave_high(r2, r3);
      c[2] = halves_low(high01, high23);
      c[3] = halves_high(high01, high23);
    }
  }
}

template <typename V>
BALLAST_INLINE void scatter_bodies(void* base, const int* at, const V* c) {
  if constexpr (requires { scatter_rows(base, at, c); }) {
    scatter_rows(base, at, c);
  } else if constexpr (sizeof(typename V::Number) == 8) {
    for (int pair = 0; pair < 3; ++pair) {
      void* part = at_offset(base, 16 * pair);
      scatter<2>(part, at, interleave_low(c[2 * pair], c[2 * pair + 1]));
      scatter<2>(part, at + 1, interleave_high(c[2 * pair], c[2 * pair + 1]));
    }
  } else {
    const V zero = V::all(0.0);
    const V low01 = interleave_low(c[0], c[1]), low23 = interleave_low(c[2], c[3]),
            high01 = interleave_high(c[0], c[1]), high23 = interleave_high(c[2], c[3]);
    scatter<4>(base, at, halves_low(low01, low23));
    scatter<4>(base, at + 1, halves_high(low01, low23));
    scatter<4>(base, at + 2, halves_low(high01, high23));
    scatter<4>(base, at + 3, halves_high(high01, high23));
    void* second = at_offset(base, 16);
    const V low45 = interleave_low(c[4], c[5]), high45 = interleave_high(c[4], c[5]);
    scatter<4>(second, at, halves_low(low45, zero));
    scatter<4>(second, at + 1, halves_high(low45, zero));
    scatter<4>(second, at + 2, halves_low(high45, zero));
    scatter<4>(second, at + 3, halves_high(high45, zero));
  }
}

}  // namespace ballast
