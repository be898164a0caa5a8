#pragma once
// Random numbers with the same bits on every machine and library: splitmix64 (Steele, Lea, Flood
// 2014) and plain arithmetic.

#include <cmath>
#include <cstdint>

namespace ballast {

class SeededRandom {
 public:
  explicit SeededRandom(std::uint64_t seed) : state_(seed) {}

  std::uint64_t next() {
    std::uint64_t z = state_ += 0x9e3779b97f4a7c15ull;
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9ull;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebull;
    return z ^ (z >> 31);
  }
  /// In [0, 1), 53 bits.
  double uniform() { return static_cast<double>(next() >> 11) * 0x1p-53; }
  double uniform(double low, double high) { return low + (high - low) * uniform(); }
  /// In [low, high], both > 0, uniform in the logarithm.
  double log_uniform(double low, double high) { return low * std::pow(high / low, uniform()); }
  /// 0 .. count - 1. The bias of the remainder is below count / 2^64.
  int index(int count) { return static_cast<int>(next() % static_cast<std::uint64_t>(count)); }

 private:
  std::uint64_t state_;
};

}  // namespace ballast
