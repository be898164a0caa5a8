#include "experiments/view/quantised.hpp"

#include <algorithm>
#include <bit>
#include <cmath>

namespace ballast {
namespace {

/// 0, -1, 1, -2, ... as 0, 1, 2, 3, ...: small numbers of either sign have small bytes.
template <class Word>
Word zigzag(Word difference) {
  const bool is_negative = difference >> (8 * sizeof(Word) - 1);
  return static_cast<Word>(static_cast<Word>(difference << 1) ^ (is_negative ? Word(~Word{}) : 0));
}

/// Column after column the zigzag differences, low bytes in the first half.
template <class Word>
std::string bytes_of_history(std::span<const Word> values, size_t columns, int order) {
  std::string bytes(values.size() * sizeof(Word), '\0');
  const size_t frames = columns ? values.size() / columns : 0;
  size_t at = 0;
  for (size_t c = 0; c < columns; ++c) {
    Word value = 0, slope = 0;
    for (size_t f = 0; f < frames; ++f, ++at) {
      const Word next = values[f * columns + c];
      Word difference = static_cast<Word>(next - value);
      value = next;
      if (order == 2) {
        const Word change = static_cast<Word>(difference - slope);
        slope = difference;
        difference = change;
      }
      const Word code = zigzag(difference);
      bytes[at] = static_cast<char>(code & 255);
      if constexpr (sizeof(Word) == 2) bytes[values.size() + at] = static_cast<char>(code >> 8);
    }
  }
  return bytes;
}

}  // namespace

std::string history_bytes(std::span<const std::uint16_t> values, size_t columns, int order) {
  return bytes_of_history(values, columns, order);
}

std::string history_bytes(std::span<const std::uint8_t> values, size_t columns) {
  return bytes_of_history(values, columns, 1);
}

std::uint16_t in_16_bits(double value, double low, double span) {
  if (!(span > 0.0)) return 0;
  return static_cast<std::uint16_t>(
      std::lround(std::clamp((value - low) / span, 0.0, 1.0) * 65535.0));
}

SmallestThree smallest_three(const Quat& q, int before) {
  const std::array<double, 4> entries{q.w(), q.x(), q.y(), q.z()};
  const auto size = [&](int k) { return std::abs(entries[static_cast<size_t>(k)]); };
  int left_out = before;
  if (before < 0 || size(before) <= least_left_out) {
    left_out = 0;
    for (int k = 1; k < 4; ++k)
      if (size(k) > size(left_out)) left_out = k;
  }
  // q and -q are one rotation: the one whose left-out entry is positive
  const double sign = entries[static_cast<size_t>(left_out)] < 0.0 ? -1.0 : 1.0;
  SmallestThree result;
  result.left_out = static_cast<std::uint8_t>(left_out);
  size_t place = 0;
  for (int k = 0; k < 4; ++k)
    if (k != left_out)
      result.kept[place++] =
          in_16_bits(sign * entries[static_cast<size_t>(k)], -largest_kept, 2.0 * largest_kept);
  return result;
}

std::uint8_t signed_root(double value) {
  const double root = std::sqrt(std::min(std::abs(value), 1.0));
  return static_cast<std::uint8_t>(128 + std::lround(127.0 * std::copysign(root, value)));
}

std::array<std::uint8_t, 2> octahedral(const Vec3& direction) {
  const Vec3 p = direction / direction.lpNorm<1>();
  double x = p.x(), y = p.y();
  if (p.z() < 0.0) {
    // the lower half is folded outward
    x = std::copysign(1.0 - std::abs(p.y()), p.x());
    y = std::copysign(1.0 - std::abs(p.x()), p.y());
  }
  return {static_cast<std::uint8_t>(std::lround(127.5 * (x + 1.0))),
          static_cast<std::uint8_t>(std::lround(127.5 * (y + 1.0)))};
}

std::string float_bytes(std::span<const double> values) {
  std::string bytes(4 * values.size(), '\0');
  for (size_t k = 0; k < values.size(); ++k) {
    const auto bits = std::bit_cast<std::uint32_t>(static_cast<float>(values[k]));
    for (size_t b = 0; b < 4; ++b)
      bytes[b * values.size() + k] = static_cast<char>(bits >> (8 * b) & 255);
  }
  return bytes;
}

std::string word_bytes(std::span<const std::uint16_t> values) {
  std::string bytes(2 * values.size(), '\0');
  for (size_t k = 0; k < values.size(); ++k) {
    bytes[k] = static_cast<char>(values[k] & 255);
    bytes[values.size() + k] = static_cast<char>(values[k] >> 8);
  }
  return bytes;
}

}  // namespace ballast
