#pragma once
// What deflated() packed, unpacked by zlib: production only packs.

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

}  // namespace ballast
