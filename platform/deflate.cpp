#include "platform/deflate.hpp"

#include <zlib.h>

#include <algorithm>

#include "platform/error.hpp"

namespace ballast {

std::string deflated(std::string_view bytes, int level) {
  uLongf size = compressBound(bytes.size());
  std::string packed(size, '\0');
  if (compress2(reinterpret_cast<Bytef*>(packed.data()), &size,
                reinterpret_cast<const Bytef*>(bytes.data()), bytes.size(), level) != Z_OK)
    throw Error("cannot compress " + std::to_string(bytes.size()) + " bytes");
  packed.resize(size);
  return packed;
}

std::string inflated(std::string_view bytes, size_t most) {
  // the size is not in the stream: the room grows until all is in it
  for (size_t room = std::clamp<size_t>(4 * bytes.size(), 64, most);;
       room = std::min(2 * room, most)) {
    std::string text(room, '\0');
    uLongf size = room;
    const int end =
        uncompress(reinterpret_cast<Bytef*>(text.data()), &size,
                   reinterpret_cast<const Bytef*>(bytes.data()), static_cast<uLong>(bytes.size()));
    text.resize(size);
    if (end == Z_OK) return text;
    if (end != Z_BUF_ERROR || room >= most) throw Error("compressed bytes are damaged");
  }
}

std::uint32_t crc32_of(std::string_view bytes) {
  return static_cast<std::uint32_t>(
      crc32(0, reinterpret_cast<const Bytef*>(bytes.data()), static_cast<uInt>(bytes.size())));
}

}  // namespace ballast
