#pragma once
// Keys of what a cached result depends on: 64-bit FNV-1a, as 16 hexadecimal digits.

#include <cstdint>
#include <cstdio>
#include <string>
#include <string_view>

namespace ballast {

inline std::uint64_t fnv1a(std::string_view bytes, std::uint64_t hash = 0xcbf29ce484222325ull) {
  for (unsigned char byte : bytes) hash = (hash ^ byte) * 0x100000001b3ull;
  return hash;
}

inline std::string content_key(std::string_view text) {
  char hex[17];
  std::snprintf(hex, sizeof hex, "%016llx", static_cast<unsigned long long>(fnv1a(text)));
  return hex;
}

}  // namespace ballast
