#pragma once
// Seeded random numbers, the same on every machine: they use integer arithmetic and additions only,
// where the standard library's distributions may differ from one library to the next.
// (RandomNumbers::log_uniform also calls libm's pow, whose last bit may differ.)

#include <bit>
#include <cmath>
#include <cstdint>

namespace ballast {

/// splitmix64 (Steele, Lea, Flood 2014): has one word of state and yields each 64-bit number once.
/// It fills the state of Random, and is enough for a shuffle.
class SplitMix64 {
 public:
  explicit SplitMix64(std::uint64_t seed) : state_(seed) {}

  std::uint64_t next() {
    std::uint64_t z = state_ += 0x9e3779b97f4a7c15u;
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
    return z ^ (z >> 31);
  }
  /// In {0, ..., n-1}. The bias of the remainder is below n/2^64.
  int below(int n) { return static_cast<int>(next() % static_cast<std::uint64_t>(n)); }

 private:
  std::uint64_t state_;
};

/// xoshiro256++ (Blackman & Vigna 2019), its state filled by splitmix64.
class Xoshiro256 {
 public:
  explicit Xoshiro256(std::uint64_t seed) {
    SplitMix64 words(seed);
    for (std::uint64_t& word : state_) word = words.next();
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
  /// In {0, ..., n-1}. The bias of the scaled uniform is below n/2^53.
  int below(int n) { return static_cast<int>(static_cast<double>(next() >> 11) * 0x1p-53 * n); }

 private:
  std::uint64_t state_[4];
};

/// Real numbers from a source of 64-bit words.
template <class Words>
class RandomNumbers : public Words {
 public:
  using Words::Words;

  /// In [0, 1), 53 random bits.
  double uniform() { return static_cast<double>(this->next() >> 11) * 0x1p-53; }
  /// In [low, high).
  double uniform(double low, double high) { return low + (high - low) * uniform(); }
  /// Between low and high, both > 0, uniform in the logarithm.
  double log_uniform(double low, double high) { return low * std::pow(high / low, uniform()); }

  /// Mean 0, variance 1, |x| <= 6: the sum of twelve uniforms less six, which needs no logarithm.
  double normal() {
    double sum = -6.0;
    for (int i = 0; i < 12; ++i) sum += uniform();
    return sum;
  }
};

/// The generator to use; packings depend on every bit of it. Random directions and rotations are in
/// geometry/shape/pose.hpp.
using Random = RandomNumbers<Xoshiro256>;

/// The generator of made problems (problems/algebra/known_solutions): a case "known:7" of a
/// published table must stay the same problem.
using ProblemRandom = RandomNumbers<SplitMix64>;

}  // namespace ballast
