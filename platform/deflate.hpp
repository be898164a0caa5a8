#pragma once
// Bytes for pages and pictures: compressed as zlib does it (RFC 1950; what browsers call "deflate",
// and what PNG files hold), and as text.

#include <cstdint>
#include <string>
#include <string_view>

namespace ballast {

/// `level`: 1 is fast, 9 is small. Throws Error when there is no memory.
std::string deflated(std::string_view bytes, int level = 6);

/// The check sum of PNG files (CRC-32).
std::uint32_t crc32_of(std::string_view bytes);

/// Bytes as printable text: three bytes become four digits of 6 bits each (RFC 4648); what lacks at
/// the end is filled with =.
std::string base64(std::string_view bytes);

}  // namespace ballast
