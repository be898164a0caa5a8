#pragma once

#include <string>
#include <string_view>

namespace ballast {

/// Bytes as printable text: three bytes become four digits of 6 bits each (RFC 4648); what lacks at
/// the end is filled with =.
std::string base64(std::string_view bytes);

}  // namespace ballast
