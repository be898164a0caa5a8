#pragma once
// The inverses of deflated() and base64(), as the program itself never unpacks.

#include <zlib.h>

#include <cstdint>
#include <string>
#include <string_view>

#include "tests/catch.hpp"

namespace ballast {

/// Inflates to at most 16 MiB.
inline std::string inflated(std::string_view bytes) {
  std::string text(size_t{1} << 24, '\0');
  uLongf size = text.size();
  REQUIRE(uncompress(reinterpret_cast<Bytef*>(text.data()), &size,
                     reinterpret_cast<const Bytef*>(bytes.data()), bytes.size()) == Z_OK);
  text.resize(size);
  return text;
}

/// The bytes that base64 letters stand for.
inline std::string from_base64(const std::string& text) {
  const std::string digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string bytes;
  REQUIRE(text.size() % 4 == 0);
  for (size_t at = 0; at < text.size(); at += 4) {
    std::uint32_t group = 0;
    int given = 0;
    for (size_t k = 0; k < 4; ++k) {
      const size_t digit = digits.find(text[at + k]);
      if (text[at + k] != '=')
        REQUIRE((digit != std::string::npos && given == static_cast<int>(k)));
      given += text[at + k] != '=';
      group = group << 6 | (text[at + k] == '=' ? 0u : static_cast<std::uint32_t>(digit));
    }
    for (int k = 0; k < given - 1; ++k) bytes += static_cast<char>(group >> (16 - 8 * k));
  }
  return bytes;
}

}  // namespace ballast
