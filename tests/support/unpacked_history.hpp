#pragma once
// The way back from the bytes of a replay, as obvious as can be: the twin of
// experiments/page/replay/decode.js.

#include <cmath>
#include <cstdint>
#include <string>
#include <vector>

#include "experiments/view/quantised.hpp"

namespace ballast {

template <class Word>
std::vector<Word> unpacked_history(const std::string& bytes, size_t columns, int order) {
  const size_t count = bytes.size() / sizeof(Word), frames = count / columns;
  std::vector<Word> values(count);
  for (size_t c = 0; c < columns; ++c) {
    long value = 0, slope = 0;
    for (size_t f = 0; f < frames; ++f) {
      long code = static_cast<unsigned char>(bytes[c * frames + f]);
      if (sizeof(Word) == 2)
        code += 256L * static_cast<unsigned char>(bytes[count + c * frames + f]);
      const long difference = code % 2 == 0 ? code / 2 : -(code + 1) / 2;
      slope = order == 2 ? slope + difference : difference;
      value += slope;
      values[f * columns + c] = static_cast<Word>(value);
    }
  }
  return values;
}

inline Quat unpacked_rotation(const std::uint16_t* kept, int left_out) {
  double entries[4], square = 0.0;
  for (int k = 0, place = 0; k < 4; ++k) {
    if (k == left_out) continue;
    entries[k] = (2.0 * kept[place++] / 65535.0 - 1.0) * largest_kept;
    square += entries[k] * entries[k];
  }
  entries[left_out] = std::sqrt(1.0 - square);
  return {entries[0], entries[1], entries[2], entries[3]};
}

}  // namespace ballast
