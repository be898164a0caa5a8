#pragma once
// Lanes of 64 bytes; a mask has one bit a lane. The functions are those of lanes_sse2.hpp, where
// they are described.

#include <immintrin.h>

#include "solvers/gauss_seidel/lanes.hpp"

// GCC 12's own intrinsics name an undefined register where a mask keeps nothing of it (GCC bug
// 105593).
#pragma GCC diagnostic ignored "-Wuninitialized"
#pragma GCC diagnostic ignored "-Wmaybe-uninitialized"

namespace ballast {

template <>
struct MaskOf<double, 64> {
  using type = __mmask8;
};
template <>
struct MaskOf<float, 64> {
  using type = __mmask16;
};
using Lanes8d = Lanes<double, 64>;
using Lanes16s = Lanes<float, 64>;

BALLAST_INLINE __mmask8 less(Lanes8d a, Lanes8d b) {
  return _mm512_cmp_pd_mask(a.x, b.x, _CMP_LT_OQ);
}
BALLAST_INLINE __mmask16 less(Lanes16s a, Lanes16s b) {
  return _mm512_cmp_ps_mask(a.x, b.x, _CMP_LT_OQ);
}
BALLAST_INLINE __mmask8 at_most(Lanes8d a, Lanes8d b) {
  return _mm512_cmp_pd_mask(a.x, b.x, _CMP_LE_OQ);
}
BALLAST_INLINE __mmask16 at_most(Lanes16s a, Lanes16s b) {
  return _mm512_cmp_ps_mask(a.x, b.x, _CMP_LE_OQ);
}
BALLAST_INLINE __mmask8 differs(Lanes8d a, Lanes8d b) {
  return _mm512_cmp_pd_mask(a.x, b.x, _CMP_NEQ_UQ);
}
BALLAST_INLINE __mmask16 differs(Lanes16s a, Lanes16s b) {
  return _mm512_cmp_ps_mask(a.x, b.x, _CMP_NEQ_UQ);
}
BALLAST_INLINE Lanes8d keep(__mmask8 mask, Lanes8d value) {
  return {_mm512_maskz_mov_pd(mask, value.x)};
}
BALLAST_INLINE Lanes16s keep(__mmask16 mask, Lanes16s value) {
  return {_mm512_maskz_mov_ps(mask, value.x)};
}
BALLAST_INLINE Lanes8d select(__mmask8 mask, Lanes8d yes, Lanes8d no) {
  return {_mm512_mask_blend_pd(mask, no.x, yes.x)};
}
BALLAST_INLINE Lanes16s select(__mmask16 mask, Lanes16s yes, Lanes16s no) {
  return {_mm512_mask_blend_ps(mask, no.x, yes.x)};
}
BALLAST_INLINE bool any(__mmask8 mask) { return mask != 0; }
BALLAST_INLINE bool any(__mmask16 mask) { return mask != 0; }
BALLAST_INLINE Lanes8d square_root(Lanes8d a) { return {_mm512_sqrt_pd(a.x)}; }
BALLAST_INLINE Lanes16s square_root(Lanes16s a) { return {_mm512_sqrt_ps(a.x)}; }

BALLAST_INLINE __m256d two_parts(const char* low, const char* high) {
  return _mm256_insertf128_pd(
      _mm256_castpd128_pd256(_mm_load_pd(reinterpret_cast<const double*>(low))),
      _mm_load_pd(reinterpret_cast<const double*>(high)), 1);
}
template <int Stride, typename V>
BALLAST_INLINE V collect(const void* base, const int* at) {
  const __m256d low = two_parts(at_offset(base, at[0]), at_offset(base, at[Stride]));
  const __m256d high = two_parts(at_offset(base, at[2 * Stride]), at_offset(base, at[3 * Stride]));
  return {(typename V::Raw)__builtin_shufflevector(low, high, 0, 1, 2, 3, 4, 5, 6, 7)};
}
template <int Stride, typename V>
BALLAST_INLINE void scatter(void* base, const int* at, V value) {
  const auto put = [ base, at ](int part, __m128d x) __attribute__((always_inline)) {
    _mm_store_pd(reinterpret_cast<double*>(at_offset(base, at[part * Stride])), x);
  };
  const __m512d parts = (__m512d)value.x;
  const __m256d low = _mm512_castpd512_pd256(parts), high = _mm512_extractf64x4_pd(parts, 1);
  put(0, _mm256_castpd256_pd128(low));
  put(1, _mm256_extractf128_pd(low, 1));
  put(2, _mm256_castpd256_pd128(high));
  put(3, _mm256_extractf128_pd(high, 1));
}

BALLAST_INLINE Lanes8d interleave_low(Lanes8d a, Lanes8d b) {
  return {_mm512_unpacklo_pd(a.x, b.x)};
}
BALLAST_INLINE Lanes8d interleave_high(Lanes8d a, Lanes8d b) {
  return {_mm512_unpackhi_pd(a.x, b.x)};
}
BALLAST_INLINE Lanes16s interleave_low(Lanes16s a, Lanes16s b) {
  return {_mm512_unpacklo_ps(a.x, b.x)};
}
BALLAST_INLINE Lanes16s interleave_high(Lanes16s a, Lanes16s b) {
  return {_mm512_unpackhi_ps(a.x, b.x)};
}
BALLAST_INLINE Lanes16s halves_low(Lanes16s a, Lanes16s b) {
  return {(__m512)_mm512_unpacklo_pd((__m512d)a.x, (__m512d)b.x)};
}
BALLAST_INLINE Lanes16s halves_high(Lanes16s a, Lanes16s b) {
  return {(__m512)_mm512_unpackhi_pd((__m512d)a.x, (__m512d)b.x)};
}

// Sixteen bodies of eight singles: a row is a register's half, loaded and stored at once.

/// Squares of four by four numbers transposed, in each sixteen bytes' place.
BALLAST_INLINE void transpose_squares(const __m512 (&rows)[4], __m512 (&columns)[4]) {
  const __m512d low01 = (__m512d)_mm512_unpacklo_ps(rows[0], rows[1]),
                high01 = (__m512d)_mm512_unpackhi_ps(rows[0], rows[1]),
                low23 = (__m512d)_mm512_unpacklo_ps(rows[2], rows[3]),
                high23 = (__m512d)_mm512_unpackhi_ps(rows[2], rows[3]);
  columns[0] = (__m512)_mm512_unpacklo_pd(low01, low23);
  columns[1] = (__m512)_mm512_unpackhi_pd(low01, low23);
  columns[2] = (__m512)_mm512_unpacklo_pd(high01, high23);
  columns[3] = (__m512)_mm512_unpackhi_pd(high01, high23);
}

/// See gather_bodies in body_lanes.hpp.
BALLAST_INLINE void gather_rows(const void* base, const int* at, Lanes16s* c) {
  const auto row = [ base, at ](int lane) __attribute__((always_inline)) {
    return _mm256_load_ps(reinterpret_cast<const float*>(at_offset(base, at[lane])));
  };
  __m512 rows[4], first[4], second[4];
  for (int half = 0; half < 2; ++half) {
    for (int k = 0; k < 4; ++k) {
      rows[k] = (__m512)_mm512_insertf64x4(_mm512_castpd256_pd512((__m256d)row(8 * half + k)),
                                           (__m256d)row(8 * half + 4 + k), 1);
    }
    transpose_squares(rows, half ? second : first);
  }
  for (int k = 0; k < 4; ++k) c[k].x = _mm512_shuffle_f32x4(first[k], second[k], 0x88);
  for (int k = 0; k < 2; ++k) c[4 + k].x = _mm512_shuffle_f32x4(first[k], second[k], 0xdd);
}

BALLAST_INLINE void scatter_rows(void* base, const int* at, const Lanes16s* c) {
  const __m512 zero = _mm512_setzero_ps();
  const __m512 last[4] = {c[4].x, c[5].x, zero, zero};
  // Sixteen bytes' places: components k of lanes 0-3, components 4 + k of lanes 0-3, then lanes
  // 4-7.
  const __m512i take[2] = {_mm512_set_epi64(11, 10, 3, 2, 9, 8, 1, 0),
                           _mm512_set_epi64(15, 14, 7, 6, 13, 12, 5, 4)};
  for (int half = 0; half < 2; ++half) {
    __m512 columns[4], rows[4];
    for (int k = 0; k < 4; ++k)
      columns[k] = (__m512)_mm512_permutex2var_pd((__m512d)c[k].x, take[half], (__m512d)last[k]);
    transpose_squares(columns, rows);
    for (int k = 0; k < 4; ++k) {
      const auto put = [ base, at ](int lane, __m256 x) __attribute__((always_inline)) {
        _mm256_store_ps(reinterpret_cast<float*>(at_offset(base, at[lane])), x);
      };
      put(8 * half + k, _mm512_castps512_ps256(rows[k]));
      put(8 * half + 4 + k, (__m256)_mm512_extractf64x4_pd((__m512d)rows[k], 1));
    }
  }
}

}  // namespace ballast
