#pragma once
// What deflated() and base64() packed, unpacked: production only packs.

#include <zlib.h>

#include <string>
#include <string_view>

#include "tests/catch.hpp"

namespace ballast {

/// Of at most 16 MiB.
inline std::string inflated(std::string_view bytes) {
  std::string text(size_t{1} << 24, '\0');
  uLongf size = text.size();
  REQUIRE(uncompress(reinterpret_cast<Bytef*>(text.data()), &size,
                     reinterpret_cast<const Bytef*>(bytes.data()), bytes.size()) == Z_OK);
  text.resize(size);
  return text;
}

/// The bytes that base64 letters stand for.
inline std::string from_base64(std::string_view letters) {
  REQUIRE(letters.size() % 4 == 0);
  std::string bytes;
  unsigned held = 0;
  int bits = 0;
  for (const char letter : letters) {
    if (letter == '=') break;
    const size_t value =
        std::string_view("ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/")
            .find(letter);
    REQUIRE(value != std::string_view::npos);
    held = held << 6 | static_cast<unsigned>(value);
    bits += 6;
    if (bits >= 8) bytes += static_cast<char>(held >> (bits -= 8) & 0xff);
  }
  return bytes;
}

}  // namespace ballast
