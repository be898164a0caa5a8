#pragma once
// Lanes of sixteen bytes, in the compiler's own vectors: SSE2 on x86-64, and any other processor.

#include "solvers/gauss_seidel/lanes.hpp"

namespace ballast {

using Lanes2d = Lanes<double, 16>;
using Lanes4s = Lanes<float, 16>;

template <typename Number>
BALLAST_INLINE typename MaskOf<Number, 16>::type less(Lanes<Number, 16> a, Lanes<Number, 16> b) {
  return a.x < b.x;
}
template <typename Number>
BALLAST_INLINE typename MaskOf<Number, 16>::type at_most(Lanes<Number, 16> a, Lanes<Number, 16> b) {
  return a.x <= b.x;
}
template <typename Number>
BALLAST_INLINE typename MaskOf<Number, 16>::type differs(Lanes<Number, 16> a, Lanes<Number, 16> b) {
  return a.x != b.x;
}
/// `value` where the mask is set, elsewhere zero.
template <typename Number>
BALLAST_INLINE Lanes<Number, 16> keep(typename MaskOf<Number, 16>::type mask,
                                      Lanes<Number, 16> value) {
  using Bits = typename MaskOf<Number, 16>::type;
  return {(Register<Number, 16>)(mask & (Bits)value.x)};
}
template <typename Number>
BALLAST_INLINE Lanes<Number, 16> select(typename MaskOf<Number, 16>::type mask,
                                        Lanes<Number, 16> yes, Lanes<Number, 16> no) {
  using Bits = typename MaskOf<Number, 16>::type;
  return {(Register<Number, 16>)((mask & (Bits)yes.x) | (~mask & (Bits)no.x))};
}
template <typename Mask>
BALLAST_INLINE bool any(Mask mask) {
  using Halves = long long __attribute__((vector_size(16)));
  const Halves halves = (Halves)mask;
  return (halves[0] | halves[1]) != 0;
}

BALLAST_INLINE Lanes2d square_root(Lanes2d a) {
  return {Lanes2d::Raw{__builtin_sqrt(a.x[0]), __builtin_sqrt(a.x[1])}};
}
BALLAST_INLINE Lanes4s square_root(Lanes4s a) {
  return {Lanes4s::Raw{__builtin_sqrtf(a.x[0]), __builtin_sqrtf(a.x[1]), __builtin_sqrtf(a.x[2]),
                       __builtin_sqrtf(a.x[3])}};
}

/// Sixteen bytes from each of the places at[0], at[Stride], ...: here from one.
template <int Stride, typename V>
BALLAST_INLINE V collect(const void* base, const int* at) {
  return {*reinterpret_cast<const typename V::Raw*>(at_offset(base, at[0]))};
}
template <int Stride, typename V>
BALLAST_INLINE void scatter(void* base, const int* at, V value) {
  *reinterpret_cast<typename V::Raw*>(at_offset(base, at[0])) = value.x;
}

/// Numbers of a and b by turns, from the first (high: second) half of every sixteen bytes.
BALLAST_INLINE Lanes2d interleave_low(Lanes2d a, Lanes2d b) {
  return {Lanes2d::Raw{a.x[0], b.x[0]}};
}
BALLAST_INLINE Lanes2d interleave_high(Lanes2d a, Lanes2d b) {
  return {Lanes2d::Raw{a.x[1], b.x[1]}};
}
BALLAST_INLINE Lanes4s interleave_low(Lanes4s a, Lanes4s b) {
  return {__builtin_shufflevector(a.x, b.x, 0, 4, 1, 5)};
}
BALLAST_INLINE Lanes4s interleave_high(Lanes4s a, Lanes4s b) {
  return {__builtin_shufflevector(a.x, b.x, 2, 6, 3, 7)};
}
/// The first (second) halves of every sixteen bytes of a, then b.
BALLAST_INLINE Lanes4s halves_low(Lanes4s a, Lanes4s b) {
  return {__builtin_shufflevector(a.x, b.x, 0, 1, 4, 5)};
}
BALLAST_INLINE Lanes4s halves_high(Lanes4s a, Lanes4s b) {
  return {__builtin_shufflevector(a.x, b.x, 2, 3, 6, 7)};
}

}  // namespace ballast
