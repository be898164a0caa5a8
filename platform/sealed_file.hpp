#pragma once
// Small binary files that are read whole or refused: what they are, in which format, and a
// checksum.
//
//   magic (8 letters), u32 format, u32 byte order, u64 bytes of the body, body, u64 checksum
//   (FNV-1a) of all before it

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>

namespace ballast {

struct SealedKind {
  std::string_view magic;         ///< 8 letters
  std::string_view name;          ///< in messages: "checkpoint"
  std::uint32_t format;           ///< written
  std::uint32_t oldest = format;  ///< formats from this one to `format` are read
};

struct SealedBody {
  std::uint32_t format = 0;
  std::string bytes;
};

/// Written to a neighbour, made safe on disk, renamed. Throws Error.
void write_sealed_file(const std::filesystem::path& file, const SealedKind& kind,
                       std::string_view body);

/// Throws Error naming the file: missing, of another kind or format, truncated, checksum wrong.
SealedBody read_sealed_file(const std::filesystem::path& file, const SealedKind& kind);

}  // namespace ballast
