#pragma once
// Lanes of numbers: one vector register, and the operations on it that the sweep's loops need.
//
// The arithmetic is + - * / square root and comparisons, lane by lane, so that every instruction
// set gives the same bits (-ffp-contract=off keeps multiplications and additions apart). Registers
// of 16 bytes are the compiler's own vectors, for SSE2 and any other processor; those of 32 bytes
// need AVX2, those of 64 bytes AVX-512.

#include <cstdint>
#include <type_traits>
#include <utility>

#if defined(__x86_64__)
#include <immintrin.h>
#endif

// Only inlined functions return vectors, so GCC's note about their calling convention does not
// apply. GCC 12's own intrinsics use an undefined register where a mask keeps nothing of it (GCC
// bug 105593).
#pragma GCC diagnostic ignored "-Wpsabi"
#pragma GCC diagnostic ignored "-Wuninitialized"
#pragma GCC diagnostic ignored "-Wmaybe-uninitialized"

/// Forces inlining. No function below is emitted on its own, so that the linker never has to choose
/// between versions for different instruction sets.
#define BALLAST_INLINE inline __attribute__((always_inline))

namespace ballast {

template <typename Number, int Bytes>
struct RegisterOf {
  typedef Number type __attribute__((vector_size(Bytes)));
};
template <typename Number, int Bytes>
using Register = typename RegisterOf<Number, Bytes>::type;

/// A register of `Bytes` bytes.
template <typename Number_, int Bytes>
struct Lanes {
  using Number = Number_;
  using Raw = Register<Number, Bytes>;
  static constexpr int bytes = Bytes, width = Bytes / sizeof(Number);
  static constexpr bool is_double = sizeof(Number) == 8;
  /// Of a comparison: all bits of a lane or none; with AVX-512 one bit for each lane.
  using Bits = std::conditional_t<is_double, std::uint8_t, std::uint16_t>;
  using Mask = std::conditional_t<Bytes == 64, Bits, decltype(Raw{} < Raw{})>;

  Raw x;

  /// Loads from aligned memory.
  static BALLAST_INLINE Lanes load(const Number* p) { return {*reinterpret_cast<const Raw*>(p)}; }
  /// Loads doubles and rounds them to singles.
  static BALLAST_INLINE Lanes load(const double* p) requires(!is_double) {
    return join(rounded(p), rounded(p + width / 2), std::make_integer_sequence<int, width>{});
  }
  /// Loads singles as doubles.
  static BALLAST_INLINE Lanes load(const float* p) requires(is_double) {
    return {__builtin_convertvector(*reinterpret_cast<const Register<float, Bytes / 2>*>(p), Raw)};
  }
  BALLAST_INLINE void store(Number* p) const { *reinterpret_cast<Raw*>(p) = x; }
  static BALLAST_INLINE Lanes all(double value) {
    return spread(static_cast<Number>(value), std::make_integer_sequence<int, width>{});
  }

  friend BALLAST_INLINE Lanes operator+(Lanes a, Lanes b) { return {a.x + b.x}; }
  friend BALLAST_INLINE Lanes operator-(Lanes a, Lanes b) { return {a.x - b.x}; }
  friend BALLAST_INLINE Lanes operator*(Lanes a, Lanes b) { return {a.x * b.x}; }
  friend BALLAST_INLINE Lanes operator*(double a, Lanes b) { return all(a) * b; }
  friend BALLAST_INLINE Lanes operator/(Lanes a, Lanes b) { return {a.x / b.x}; }

 private:
  template <int... Lane>
  static BALLAST_INLINE Lanes spread(Number value, std::integer_sequence<int, Lane...>) {
    return {Raw{(static_cast<void>(Lane), value)...}};
  }
  static BALLAST_INLINE auto rounded(const double* p) {
    return __builtin_convertvector(*reinterpret_cast<const Register<double, Bytes>*>(p),
                                   Register<float, Bytes / 2>);
  }
  template <int... Lane>
  static BALLAST_INLINE Lanes join(Register<float, Bytes / 2> low, Register<float, Bytes / 2> high,
                                   std::integer_sequence<int, Lane...>) {
    return {__builtin_shufflevector(low, high, Lane...)};
  }
};

template <typename V>
concept OneBitMasks = V::bytes == 64;
template <typename V>
concept CompilersOwn = V::bytes == 16;

template <typename V>
BALLAST_INLINE typename V::Mask less(V a, V b) {
  return a.x < b.x;
}
template <typename V>
BALLAST_INLINE typename V::Mask at_most(V a, V b) {
  return a.x <= b.x;
}
template <typename V>
BALLAST_INLINE typename V::Mask differs(V a, V b) {
  return a.x != b.x;
}
/// Returns `value` where the mask is set, zero elsewhere.
template <typename V>
BALLAST_INLINE V keep(typename V::Mask mask, V value) {
  return {(typename V::Raw)(mask & (typename V::Mask)value.x)};
}
template <CompilersOwn V>
BALLAST_INLINE V select(typename V::Mask mask, V yes, V no) {
  using Mask = typename V::Mask;
  return {(typename V::Raw)((mask & (Mask)yes.x) | (~mask & (Mask)no.x))};
}
template <CompilersOwn V>
BALLAST_INLINE V square_root(V a) {
  if constexpr (V::is_double)
    return {typename V::Raw{__builtin_sqrt(a.x[0]), __builtin_sqrt(a.x[1])}};
  else
    return {typename V::Raw{__builtin_sqrtf(a.x[0]), __builtin_sqrtf(a.x[1]),
                            __builtin_sqrtf(a.x[2]), __builtin_sqrtf(a.x[3])}};
}
template <typename Mask>
BALLAST_INLINE bool any(Mask mask) {
  using Halves = long long __attribute__((vector_size(16)));
  const Halves halves = (Halves)mask;
  return (halves[0] | halves[1]) != 0;
}

#if defined(__x86_64__)
template <int Bytes>
using Doubles = Lanes<double, Bytes>;
template <int Bytes>
using Singles = Lanes<float, Bytes>;

BALLAST_INLINE Doubles<32> select(Doubles<32>::Mask mask, Doubles<32> yes, Doubles<32> no) {
  return {_mm256_blendv_pd(no.x, yes.x, (__m256d)mask)};
}
BALLAST_INLINE Singles<32> select(Singles<32>::Mask mask, Singles<32> yes, Singles<32> no) {
  return {_mm256_blendv_ps(no.x, yes.x, (__m256)mask)};
}
BALLAST_INLINE Doubles<32> square_root(Doubles<32> a) { return {_mm256_sqrt_pd(a.x)}; }
BALLAST_INLINE Singles<32> square_root(Singles<32> a) { return {_mm256_sqrt_ps(a.x)}; }
BALLAST_INLINE bool any(Doubles<32>::Mask mask) { return _mm256_movemask_pd((__m256d)mask) != 0; }
BALLAST_INLINE bool any(Singles<32>::Mask mask) { return _mm256_movemask_ps((__m256)mask) != 0; }

template <int Condition, OneBitMasks V>
BALLAST_INLINE typename V::Mask compare(V a, V b) {
  if constexpr (V::is_double)
    return _mm512_cmp_pd_mask(a.x, b.x, Condition);
  else
    return _mm512_cmp_ps_mask(a.x, b.x, Condition);
}
template <OneBitMasks V>
BALLAST_INLINE typename V::Mask less(V a, V b) {
  return compare<_CMP_LT_OQ>(a, b);
}
template <OneBitMasks V>
BALLAST_INLINE typename V::Mask at_most(V a, V b) {
  return compare<_CMP_LE_OQ>(a, b);
}
template <OneBitMasks V>
BALLAST_INLINE typename V::Mask differs(V a, V b) {
  return compare<_CMP_NEQ_UQ>(a, b);
}
template <OneBitMasks V>
BALLAST_INLINE V keep(typename V::Mask mask, V value) {
  if constexpr (V::is_double)
    return {_mm512_maskz_mov_pd(mask, value.x)};
  else
    return {_mm512_maskz_mov_ps(mask, value.x)};
}
BALLAST_INLINE Doubles<64> select(__mmask8 mask, Doubles<64> yes, Doubles<64> no) {
  return {_mm512_mask_blend_pd(mask, no.x, yes.x)};
}
BALLAST_INLINE Singles<64> select(__mmask16 mask, Singles<64> yes, Singles<64> no) {
  return {_mm512_mask_blend_ps(mask, no.x, yes.x)};
}
BALLAST_INLINE Doubles<64> square_root(Doubles<64> a) { return {_mm512_sqrt_pd(a.x)}; }
BALLAST_INLINE Singles<64> square_root(Singles<64> a) { return {_mm512_sqrt_ps(a.x)}; }
BALLAST_INLINE bool any(__mmask8 mask) { return mask != 0; }
BALLAST_INLINE bool any(__mmask16 mask) { return mask != 0; }
#endif

/// The row of a body at `offset` bytes from `base`: byte offsets save the loop its shifts.
template <typename Row>
BALLAST_INLINE Row* at_offset(Row* base, int offset) {
  using Byte = std::conditional_t<std::is_const_v<Row>, const char, char>;
  return reinterpret_cast<Row*>(reinterpret_cast<Byte*>(base) + static_cast<unsigned>(offset));
}

// The functions below move the bodies of several contacts from rows to lanes and back. They load
// and store pieces of one size: sixteen bytes, or a whole row where the instruction set allows it.
// (A load that is larger than the store before it waits until that store has reached the cache.)
// `Scale`: the offsets are multiplied by it.

using Sixteen = Register<double, 16>;

/// Collects sixteen bytes from each of the byte offsets at[0], at[Stride], ...
template <int Stride, int Scale, typename V>
BALLAST_INLINE V collect(const void* base, const int* at) {
  using Raw = typename V::Raw;
  const auto part = [ base, at ](int k) __attribute__((always_inline)) {
    return *reinterpret_cast<const Sixteen*>(at_offset(base, Scale * at[k * Stride]));
  };
  if constexpr (V::bytes == 16) {
    return {(Raw)part(0)};
  } else {
    const auto two = [&part](int k) __attribute__((always_inline)) {
      return __builtin_shufflevector(part(k), part(k + 1), 0, 1, 2, 3);
    };
    if constexpr (V::bytes == 32)
      return {(Raw)two(0)};
    else
      return {(Raw)__builtin_shufflevector(two(0), two(2), 0, 1, 2, 3, 4, 5, 6, 7)};
  }
}
template <int Stride, int Scale, typename V>
BALLAST_INLINE void scatter(void* base, const int* at, V value) {
  const auto put = [ base, at ](int k, Sixteen x) __attribute__((always_inline)) {
    *reinterpret_cast<Sixteen*>(at_offset(base, Scale * at[k * Stride])) = x;
  };
  const auto put_two = [&put](int k, Register<double, 32> x) __attribute__((always_inline)) {
    put(k, __builtin_shufflevector(x, x, 0, 1));
    put(k + 1, __builtin_shufflevector(x, x, 2, 3));
  };
  const auto all = (Register<double, V::bytes>)value.x;
  if constexpr (V::bytes == 16) {
    put(0, all);
  } else if constexpr (V::bytes == 32) {
    put_two(0, all);
  } else {
    put_two(0, __builtin_shufflevector(all, all, 0, 1, 2, 3));
    put_two(2, __builtin_shufflevector(all, all, 4, 5, 6, 7));
  }
}

/// Alternates Run numbers of a and Run of b, from one half (`Second`: the upper) of every 16 bytes.
template <int Run, bool Second, typename V, int... Lane>
BALLAST_INLINE V interleave(V a, V b, std::integer_sequence<int, Lane...>) {
  constexpr int square = 16 / sizeof(typename V::Number);  // numbers in sixteen bytes
  constexpr auto from = [](int lane) {
    const int k = lane % square, turn = k / Run;
    return lane - k + Second * square / 2 + turn / 2 * Run + k % Run + turn % 2 * V::width;
  };
  return {__builtin_shufflevector(a.x, b.x, from(Lane)...)};
}
template <int Run, bool Second, typename V>
BALLAST_INLINE V interleave(V a, V b) {
  return interleave<Run, Second>(a, b, std::make_integer_sequence<int, V::width>{});
}

/// Transposes squares of four by four singles: one square for each sixteen bytes of a register.
template <typename V>
BALLAST_INLINE void transpose_squares(const V* rows, V* columns) {
  const V low01 = interleave<1, false>(rows[0], rows[1]),
          low23 = interleave<1, false>(rows[2], rows[3]),
          high01 = interleave<1, true>(rows[0], rows[1]),
          high23 = interleave<1, true>(rows[2], rows[3]);
  columns[0] = interleave<2, false>(low01, low23);
  columns[1] = interleave<2, true>(low01, low23);
  columns[2] = interleave<2, false>(high01, high23);
  columns[3] = interleave<2, true>(high01, high23);
}

/// Loads six numbers of each row at `at[0]`, `at[1]`, ...: component k of all rows goes to c[k].
template <int Scale = 1, typename V>
BALLAST_INLINE void gather_bodies(const void* base, const int* at, V* c) {
  if constexpr (V::is_double) {
    for (int pair = 0; pair < 3; ++pair) {
      const void* part = at_offset(base, 16 * pair);
      const V even = collect<2, Scale, V>(part, at), odd = collect<2, Scale, V>(part, at + 1);
      c[2 * pair] = interleave<1, false>(even, odd);
      c[2 * pair + 1] = interleave<1, true>(even, odd);
    }
  } else {
    V rows[4], last[4];
    for (int k = 0; k < 4; ++k) rows[k] = collect<4, Scale, V>(base, at + k);
    transpose_squares(rows, c);
    for (int k = 0; k < 4; ++k) rows[k] = collect<4, Scale, V>(at_offset(base, 16), at + k);
    transpose_squares(rows, last);
    c[4] = last[0];
    c[5] = last[1];
  }
}

template <int Scale = 1, typename V>
BALLAST_INLINE void scatter_bodies(void* base, const int* at, const V* c) {
  if constexpr (V::is_double) {
    for (int pair = 0; pair < 3; ++pair) {
      void* part = at_offset(base, 16 * pair);
      scatter<2, Scale>(part, at, interleave<1, false>(c[2 * pair], c[2 * pair + 1]));
      scatter<2, Scale>(part, at + 1, interleave<1, true>(c[2 * pair], c[2 * pair + 1]));
    }
  } else {
    const V last[4] = {c[4], c[5], V::all(0.0), V::all(0.0)};
    V rows[4];
    transpose_squares(c, rows);
    for (int k = 0; k < 4; ++k) scatter<4, Scale>(base, at + k, rows[k]);
    transpose_squares(last, rows);
    for (int k = 0; k < 4; ++k) scatter<4, Scale>(at_offset(base, 16), at + k, rows[k]);
  }
}

#if defined(__x86_64__)
// Sixteen bodies of eight singles each: a row fills half a register and is loaded and stored whole.

template <int Scale = 1>
BALLAST_INLINE void gather_bodies(const void* base, const int* at, Singles<64>* c) {
  static_assert(Scale == 1);
  const auto row = [ base, at ](int lane) __attribute__((always_inline)) {
    return _mm256_load_pd(reinterpret_cast<const double*>(at_offset(base, at[lane])));
  };
  Singles<64> rows[4], columns[2][4];
  for (int half = 0; half < 2; ++half) {
    for (int k = 8 * half; k < 8 * half + 4; ++k)
      rows[k % 4].x = (__m512)_mm512_insertf64x4(_mm512_castpd256_pd512(row(k)), row(k + 4), 1);
    transpose_squares(rows, columns[half]);
  }
  for (int k = 0; k < 4; ++k) c[k].x = _mm512_shuffle_f32x4(columns[0][k].x, columns[1][k].x, 0x88);
  for (int k = 0; k < 2; ++k)
    c[4 + k].x = _mm512_shuffle_f32x4(columns[0][k].x, columns[1][k].x, 0xdd);
}

template <int Scale = 1>
BALLAST_INLINE void scatter_bodies(void* base, const int* at, const Singles<64>* c) {
  static_assert(Scale == 1);
  const __m512d zero = _mm512_setzero_pd(),
                last[4] = {(__m512d)c[4].x, (__m512d)c[5].x, zero, zero};
  // The sixteen bytes of columns[k] in half 0: component k, then component 4 + k of lanes 0-3, then
  // both of lanes 4-7.
  const __m512i take[2] = {_mm512_set_epi64(11, 10, 3, 2, 9, 8, 1, 0),
                           _mm512_set_epi64(15, 14, 7, 6, 13, 12, 5, 4)};
  for (int half = 0; half < 2; ++half) {
    Singles<64> columns[4], rows[4];
    for (int k = 0; k < 4; ++k)
      columns[k].x = (__m512)_mm512_permutex2var_pd((__m512d)c[k].x, take[half], last[k]);
    transpose_squares(columns, rows);
    const auto put = [ base, at ](int lane, __m256d x) __attribute__((always_inline)) {
      _mm256_store_pd(reinterpret_cast<double*>(at_offset(base, at[lane])), x);
    };
    for (int k = 0; k < 4; ++k) {
      put(8 * half + k, _mm512_castpd512_pd256((__m512d)rows[k].x));
      put(8 * half + 4 + k, _mm512_extractf64x4_pd((__m512d)rows[k].x, 1));
    }
  }
}
#endif

}  // namespace ballast
