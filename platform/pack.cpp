#include "platform/pack.hpp"

#include "platform/atomic_file.hpp"
#include "platform/text.hpp"

namespace ballast {
namespace {

constexpr std::uint32_t this_byte_order = 0x01020304;
constexpr size_t head_bytes = 24, checksum_bytes = 8;

}  // namespace

void write_sealed_file(const std::filesystem::path& file, const SealedKind& kind,
                       std::string_view body) {
  // The file, in bytes:   | magic 8 | format 4 | byte order 4 | length 8 | body | checksum 8 |
  Packer head;
  head.fixed(kind.magic);
  head.numbers(kind.format, this_byte_order, std::uint64_t{body.size()});
  Packer checksum;
  checksum.number(fnv1a(body, fnv1a(head.bytes())));
  AtomicFile out(file);
  for (const std::string_view part :
       {std::string_view(head.bytes()), body, std::string_view(checksum.bytes())})
    out.write(part);
  out.commit();
}

std::string read_sealed_file(const std::filesystem::path& file, const SealedKind& kind) {
  const std::string bytes = read_whole_file(file);
  const std::string name(kind.name);
  const auto refuse = [&](const std::string& why) { throw Error(file.string() + ": " + why); };
  // A file that is cut off within its magic is truncated; it is not one of another kind.
  if (bytes.empty()) refuse(name + " is empty");
  if (bytes.compare(0, kind.magic.size(), kind.magic.substr(0, bytes.size())) != 0)
    refuse("is not a " + name);
  if (bytes.size() < head_bytes)
    refuse(name + " is truncated in its first " + std::to_string(head_bytes) + " bytes");
  const std::string_view all(bytes);
  Unpacker head(all.substr(kind.magic.size()), file.string() + ": " + name);
  std::uint32_t format = 0, byte_order = 0;
  std::uint64_t body = 0, checksum = 0;
  head.numbers(format, byte_order, body);
  if (byte_order != this_byte_order)
    refuse(name + " was written on a machine of another byte order");
  if (format != kind.format)
    refuse(name + " has format " + std::to_string(format) + ", this program reads format " +
           std::to_string(kind.format));
  const std::uint64_t rest = bytes.size() - head_bytes;
  if (rest < checksum_bytes || body > rest - checksum_bytes)
    refuse(name + " is truncated: " + std::to_string(bytes.size()) + " bytes are there");
  if (body < rest - checksum_bytes) refuse(name + " is damaged: bytes follow its end");
  Unpacker end(all.substr(bytes.size() - checksum_bytes), file.string() + ": " + name);
  end.number(checksum);
  if (checksum != fnv1a(all.substr(0, bytes.size() - checksum_bytes)))
    refuse(name + " is damaged: its checksum is wrong");
  return bytes.substr(head_bytes, body);
}

}  // namespace ballast
