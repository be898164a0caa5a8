#pragma once
// Numbers as few bytes for a page. The page's side of it is experiments/page/replay/decode.js.
//
// A history holds frames of equally many columns, values[frame * columns + column]. Its bytes are
// the differences in time of every column, one column after the other, as zigzag numbers (0, -1, 1,
// -2, ...), all low bytes before all high ones: mostly zeros, which deflate packs well.

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "geometry/shape/pose.hpp"

namespace ballast {

/// `order`: differences of differences of ... (1 or 2). Modulo 2^16: nothing overflows.
std::string history_bytes(std::span<const std::uint16_t> values, size_t columns, int order);
/// The same of small numbers, without high bytes and of order 1.
std::string history_bytes(std::span<const std::uint8_t> values, size_t columns);

/// The place of `value` in [low, low + span] in 16 bits; an empty span gives 0.
std::uint16_t in_16_bits(double value, double low, double span);

/// A unit quaternion without its largest entry, which follows from the others.
struct SmallestThree {
  std::array<std::uint16_t, 3> kept{};
  std::uint8_t left_out = 0;  ///< 0 .. 3: w x y z
};
/// An entry of `q` that is left out may be as small as `least_left_out`: the kept ones are in
/// [-largest_kept, largest_kept].
inline constexpr double least_left_out = 0.55;
inline const double largest_kept = std::sqrt(1.0 - least_left_out * least_left_out);
/// `before`: what was left out a frame earlier, and is again while it may be: then the numbers
/// don't jump.
SmallestThree smallest_three(const Quat& q, int before = -1);

/// -1 .. 1 in 8 bits (0 is 128), with a root's steps: fine near 0. The error is at most 1/127 of
/// the root.
std::uint8_t signed_root(double value);

/// A unit vector in 2 bytes: on an octahedron, unfolded (Cigolle et al. 2014). Within 0.02.
std::array<std::uint8_t, 2> octahedral(const Vec3& direction);

/// Numbers in single precision, first bytes before second ones and so on: neighbours are alike.
std::string float_bytes(std::span<const double> values);
/// Whole numbers of 16 bits, low bytes before high ones.
std::string word_bytes(std::span<const std::uint16_t> values);

}  // namespace ballast
