#pragma once
// Bytes for pages and pictures: compressed in zlib's format (RFC 1950; browsers call it "deflate",
// and PNG files hold it), and encoded as text.

#include <cstdint>
#include <string>
#include <string_view>

namespace ballast {

/// Returns compressed bytes. `level` 1 is fast, 9 is small. Throws Error when there is no memory.
std::string deflated(std::string_view bytes, int level = 6);

/// The check sum of PNG files (CRC-32).
std::uint32_t crc32_of(std::string_view bytes);

/// Bytes as printable text: three bytes become four digits of 6 bits each (RFC 4648); the end is
/// padded with =.
std::string base64(std::string_view bytes);

}  // namespace ballast
