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
  const std::string bytes = read_whole_file(file), name(kind.name);
  const std::string_view all(bytes);
  const auto refuse = [&](const std::string& why) { throw Error(file.string() + ": " + why); };
  // A file that is cut off within its magic is truncated; it is not one of another kind.
  if (all.empty()) refuse(name + " is empty");
  if (!all.starts_with(kind.magic.substr(0, all.size()))) refuse("is not a " + name);
  const std::string broken = name + " is truncated or damaged";
  if (all.size() < head_bytes + checksum_bytes) refuse(broken);
  const std::string_view sealed = all.substr(0, all.size() - checksum_bytes);
  Unpacker head(all.substr(kind.magic.size()), name), end(all.substr(sealed.size()), name);
  std::uint32_t format = 0, byte_order = 0;
  std::uint64_t body = 0, checksum = 0;
  head.numbers(format, byte_order, body);
  end.number(checksum);
  if (byte_order != this_byte_order)
    refuse(name + " was written on a machine of another byte order");
  if (format != kind.format)
    refuse(name + " has format " + std::to_string(format) + ", this program reads format " +
           std::to_string(kind.format));
  if (body != sealed.size() - head_bytes || checksum != fnv1a(sealed)) refuse(broken);
  return bytes.substr(head_bytes, body);
}

}  // namespace ballast
