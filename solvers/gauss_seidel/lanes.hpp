#pragma once
// Lanes of numbers: one vector register, and the operations that all instruction sets have alike.
//
// Only + - * / square root and comparisons, lane by lane: every instruction set gives the same
// bits (-ffp-contract=off keeps multiplications and additions apart). What the sets say
// differently is in lanes_sse2.hpp, lanes_avx2.hpp and lanes_avx512.hpp; a source includes one.

#include <cstddef>
#include <type_traits>
#include <utility>

// Vectors are returned by inlined functions only, so GCC's note about their calling convention does
// not apply.
#pragma GCC diagnostic ignored "-Wpsabi"

/// Inlined for certain. No function below is emitted on its own, so that the linker never has to
/// choose between versions for different instruction sets.
#define BALLAST_INLINE inline __attribute__((always_inline))

namespace ballast {

template <typename Number, int Bytes>
struct RegisterOf {
  typedef Number type __attribute__((vector_size(Bytes)));
};
template <typename Number, int Bytes>
using Register = typename RegisterOf<Number, Bytes>::type;

/// What a comparison of vectors gives: all bits of a lane, or none. AVX-512 has one bit a lane.
template <typename Number, int Bytes>
struct MaskOf {
  using type = decltype(Register<Number, Bytes>{} < Register<Number, Bytes>{});
};

/// A register of `Bytes` bytes.
template <typename Number_, int Bytes>
struct Lanes {
  using Number = Number_;
  using Raw = Register<Number, Bytes>;
  using Mask = typename MaskOf<Number, Bytes>::type;
  static constexpr int width = Bytes / sizeof(Number);

  Raw x;

  /// From aligned memory.
  static BALLAST_INLINE Lanes load(const Number* p) { return {*reinterpret_cast<const Raw*>(p)}; }
  BALLAST_INLINE void store(Number* p) const { *reinterpret_cast<Raw*>(p) = x; }
  static BALLAST_INLINE Lanes all(double value) {
    return spread(static_cast<Number>(value), std::make_integer_sequence<int, width>{});
  }

  friend BALLAST_INLINE Lanes operator+(Lanes a, Lanes b) { return {a.x + b.x}; }
  friend BALLAST_INLINE Lanes operator-(Lanes a, Lanes b) { return {a.x - b.x}; }
  friend BALLAST_INLINE Lanes operator*(Lanes a, Lanes b) { return {a.x * b.x}; }
  friend BALLAST_INLINE Lanes operator/(Lanes a, Lanes b) { return {a.x / b.x}; }

 private:
  template <int... Lane>
  static BALLAST_INLINE Lanes spread(Number value, std::integer_sequence<int, Lane...>) {
    return {Raw{(static_cast<void>(Lane), value)...}};
  }
};

/// A row of a body, named by its distance in bytes: no shifts in the loop.
BALLAST_INLINE const char* at_offset(const void* base, int offset) {
  return static_cast<const char*>(base) + static_cast<unsigned>(offset);
}
BALLAST_INLINE char* at_offset(void* base, int offset) {
  return static_cast<char*>(base) + static_cast<unsigned>(offset);
}

}  // namespace ballast
