#pragma once
// Compression as zlib does it (RFC 1950): what browsers call "deflate", and what PNG files hold.

#include <cstdint>
#include <string>
#include <string_view>

namespace ballast {

/// `level`: 1 is fast, 9 is small. Throws Error when there is no memory.
std::string deflated(std::string_view bytes, int level = 6);

/// The check sum of PNG files (CRC-32).
std::uint32_t crc32_of(std::string_view bytes);

}  // namespace ballast
