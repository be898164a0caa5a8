#pragma once
// A seeded generator whose numbers are the same on every machine: integer arithmetic, additions and
// square roots only, where the standard library's distributions and libm's functions may differ.

#include <bit>
#include <cmath>
#include <cstdint>

#include "geometry/shape/pose.hpp"

namespace ballast {

/// xoshiro256++ (Blackman & Vigna 2019), its state filled by splitmix64.
class Random {
 public:
  explicit Random(std::uint64_t seed) {
    for (std::uint64_t& word : state_) word = splitmix(seed);
  }

  /// Advances `state` and returns the next number of splitmix64; also a good mixer of (seed, index)
  /// pairs.
  static std::uint64_t splitmix(std::uint64_t& state) {
    std::uint64_t z = (state += 0x9e3779b97f4a7c15u);
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
    return z ^ (z >> 31);
  }

  std::uint64_t next() {
    const std::uint64_t result = std::rotl(state_[0] + state_[3], 23) + state_[0];
    const std::uint64_t t = state_[1] << 17;
    state_[2] ^= state_[0];
    state_[3] ^= state_[1];
    state_[1] ^= state_[2];
    state_[0] ^= state_[3];
    state_[2] ^= t;
    state_[3] = std::rotl(state_[3], 45);
    return result;
  }

  /// In [0, 1), 53 random bits.
  double uniform() { return static_cast<double>(next() >> 11) * 0x1p-53; }
  /// In [low, high).
  double uniform(double low, double high) { return low + (high - low) * uniform(); }
  /// In {0, ..., n-1}; the bias of the scaled uniform is below n/2^53.
  int below(int n) { return static_cast<int>(uniform() * n); }

  /// Mean 0, variance 1, |x| <= 6: the sum of twelve uniforms less six, which needs no logarithm.
  double normal() {
    double sum = -6.0;
    for (int i = 0; i < 12; ++i) sum += uniform();
    return sum;
  }

  /// Uniform on the sphere (rejection from the cube).
  Vec3 unit_vector() {
    while (true) {
      const double x = uniform(-1.0, 1.0), y = uniform(-1.0, 1.0), z = uniform(-1.0, 1.0);
      const double length_sq = x * x + y * y + z * z;
      if (length_sq <= 1.0 && length_sq > 1e-6) return Vec3(x, y, z) / std::sqrt(length_sq);
    }
  }

  /// Uniform over rotations (rejection in four dimensions).
  Quat rotation() {
    while (true) {
      const double w = uniform(-1.0, 1.0), x = uniform(-1.0, 1.0), y = uniform(-1.0, 1.0),
                   z = uniform(-1.0, 1.0);
      const double length_sq = w * w + x * x + y * y + z * z;
      if (length_sq > 1.0 || length_sq < 1e-6) continue;
      const double length = std::sqrt(length_sq);
      return Quat(w / length, x / length, y / length, z / length);
    }
  }

 private:
  std::uint64_t state_[4];
};

}  // namespace ballast
