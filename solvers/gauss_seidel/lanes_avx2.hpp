#pragma once
// Lanes of 32 bytes. The functions are those of lanes_sse2.hpp, where they are described.

#include <immintrin.h>

#include "solvers/gauss_seidel/lanes.hpp"

namespace ballast {

using Lanes4d = Lanes<double, 32>;
using Lanes8s = Lanes<float, 32>;
using Mask4d = Lanes4d::Mask;
using Mask8s = Lanes8s::Mask;

BALLAST_INLINE Mask4d less(Lanes4d a, Lanes4d b) { return a.x < b.x; }
BALLAST_INLINE Mask8s less(Lanes8s a, Lanes8s b) { return a.x < b.x; }
BALLAST_INLINE Mask4d at_most(Lanes4d a, Lanes4d b) { return a.x <= b.x; }
BALLAST_INLINE Mask8s at_most(Lanes8s a, Lanes8s b) { return a.x <= b.x; }
BALLAST_INLINE Mask4d differs(Lanes4d a, Lanes4d b) { return a.x != b.x; }
BALLAST_INLINE Mask8s differs(Lanes8s a, Lanes8s b) { return a.x != b.x; }
BALLAST_INLINE Lanes4d keep(Mask4d mask, Lanes4d value) {
  return {_mm256_and_pd((__m256d)mask, value.x)};
}
BALLAST_INLINE Lanes8s keep(Mask8s mask, Lanes8s value) {
  return {_mm256_and_ps((__m256)mask, value.x)};
}
BALLAST_INLINE Lanes4d select(Mask4d mask, Lanes4d yes, Lanes4d no) {
  return {_mm256_blendv_pd(no.x, yes.x, (__m256d)mask)};
}
BALLAST_INLINE Lanes8s select(Mask8s mask, Lanes8s yes, Lanes8s no) {
  return {_mm256_blendv_ps(no.x, yes.x, (__m256)mask)};
}
BALLAST_INLINE bool any(Mask4d mask) { return _mm256_movemask_pd((__m256d)mask) != 0; }
BALLAST_INLINE bool any(Mask8s mask) { return _mm256_movemask_ps((__m256)mask) != 0; }
BALLAST_INLINE Lanes4d square_root(Lanes4d a) { return {_mm256_sqrt_pd(a.x)}; }
BALLAST_INLINE Lanes8s square_root(Lanes8s a) { return {_mm256_sqrt_ps(a.x)}; }

BALLAST_INLINE __m256 two_parts(const char* low, const char* high) {
  return _mm256_insertf128_ps(
      _mm256_castps128_ps256(_mm_load_ps(reinterpret_cast<const float*>(low))),
      _mm_load_ps(reinterpret_cast<const float*>(high)), 1);
}
template <int Stride, typename V>
BALLAST_INLINE V collect(const void* base, const int* at) {
  return {(typename V::Raw)two_parts(at_offset(base, at[0]), at_offset(base, at[Stride]))};
}
template <int Stride, typename V>
BALLAST_INLINE void scatter(void* base, const int* at, V value) {
  const __m256 parts = (__m256)value.x;
  _mm_store_ps(reinterpret_cast<float*>(at_offset(base, at[0])), _mm256_castps256_ps128(parts));
  _mm_store_ps(reinterpret_cast<float*>(at_offset(base, at[Stride])),
               _mm256_extractf128_ps(parts, 1));
}

BALLAST_INLINE Lanes4d interleave_low(Lanes4d a, Lanes4d b) {
  return {_mm256_unpacklo_pd(a.x, b.x)};
}
BALLAST_INLINE Lanes4d interleave_high(Lanes4d a, Lanes4d b) {
  return {_mm256_unpackhi_pd(a.x, b.x)};
}
BALLAST_INLINE Lanes8s interleave_low(Lanes8s a, Lanes8s b) {
  return {_mm256_unpacklo_ps(a.x, b.x)};
}
BALLAST_INLINE Lanes8s interleave_high(Lanes8s a, Lanes8s b) {
  return {_mm256_unpackhi_ps(a.x, b.x)};
}
BALLAST_INLINE Lanes8s halves_low(Lanes8s a, Lanes8s b) {
  return {(__m256)_mm256_unpacklo_pd((__m256d)a.x, (__m256d)b.x)};
}
BALLAST_INLINE Lanes8s halves_high(Lanes8s a, Lanes8s b) {
  return {(__m256)_mm256_unpackhi_pd((__m256d)a.x, (__m256d)b.x)};
}

}  // namespace ballast
