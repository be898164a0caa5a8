#pragma once
// Keys of what a cached result depends on: 64-bit FNV-1a, as 16 hexadecimal digits.

#include <cstdint>
#include <string>
#include <string_view>

#include "platform/text.hpp"

namespace ballast {

inline std::uint64_t fnv1a(std::string_view bytes, std::uint64_t hash = 0xcbf29ce484222325ull) {
  for (unsigned char byte : bytes) hash = (hash ^ byte) * 0x100000001b3ull;
  return hash;
}

inline std::string hash_text(std::uint64_t hash) {
  return printed("%016llx", static_cast<unsigned long long>(hash));
}

inline std::string content_key(std::string_view text) { return hash_text(fnv1a(text)); }

}  // namespace ballast
