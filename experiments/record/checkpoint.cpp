#include "experiments/record/checkpoint.hpp"

#include <cstdint>
#include <cstring>
#include <type_traits>

#include "platform/atomic_file.hpp"
#include "platform/content_key.hpp"
#include "platform/error.hpp"

// magic "BALLCKPT", u32 version, u32 byte order, u64 bytes of the body, body, u64 checksum of all
// before it. Body: key, phase; time, step, body count, poses (position, w x y z), velocities,
// spins; contacts; impulses; numbers; each list and text led by its u64 length.

namespace ballast {

namespace {

constexpr std::string_view magic = "BALLCKPT";
constexpr std::uint32_t version = 1;
constexpr std::uint32_t byte_order = 0x01020304;
constexpr size_t head_bytes = 24, checksum_bytes = 8;

class Packer {
 public:
  template <class Number>
  void number(Number value) {
    static_assert(std::is_arithmetic_v<Number>);
    bytes.append(reinterpret_cast<const char*>(&value), sizeof value);
  }
  void text(std::string_view value) {
    number(std::uint64_t{value.size()});
    bytes += value;
  }
  void vector(const Vec3& value) {
    for (int k = 0; k < 3; ++k) number(value[k]);
  }
  template <class List, class Write>
  void list(const List& values, Write&& write) {
    number(std::uint64_t{values.size()});
    for (const auto& value : values) write(value);
  }

  std::string bytes;
};

/// Its ends are checked as well as the checksum, so that a file made wrong is an error and not a
/// crash.
class Unpacker {
 public:
  Unpacker(std::string_view bytes, const std::filesystem::path& file)
      : bytes_(bytes), file_(file) {}

  template <class Number>
  Number number() {
    Number value;
    std::memcpy(&value, take(sizeof value).data(), sizeof value);
    return value;
  }
  std::string text() {
    const size_t length = count(1);
    return std::string(take(length));
  }
  Vec3 vector() {
    Vec3 value;
    for (int k = 0; k < 3; ++k) value[k] = number<double>();
    return value;
  }
  template <class Value, class Read>
  void list(std::vector<Value>& values, size_t bytes_each, Read&& read) {
    values.resize(count(bytes_each));
    for (Value& value : values) value = read();
  }
  void end() const {
    if (!bytes_.empty()) refuse();
  }
  void same(size_t length, size_t expected) const {
    if (length != expected) refuse();
  }

 private:
  [[noreturn]] void refuse() const {
    throw Error(file_.string() + ": checkpoint is inconsistent: a list has a wrong length");
  }
  size_t count(size_t bytes_each) {
    const auto length = number<std::uint64_t>();
    if (length > bytes_.size() / bytes_each) refuse();
    return length;
  }
  std::string_view take(size_t length) {
    if (length > bytes_.size()) refuse();
    const std::string_view taken = bytes_.substr(0, length);
    bytes_.remove_prefix(length);
    return taken;
  }

  std::string_view bytes_;
  const std::filesystem::path& file_;
};

std::string pack_body(const Checkpoint& checkpoint) {
  Packer pack;
  pack.text(checkpoint.key);
  pack.text(checkpoint.phase);
  const MotionState& state = checkpoint.state;
  pack.number(state.time);
  pack.number(std::int64_t{state.step});
  pack.list(state.pose, [&](const Pose& pose) {
    pack.vector(pose.position);
    for (double part : {pose.rotation.w(), pose.rotation.x(), pose.rotation.y(), pose.rotation.z()})
      pack.number(part);
  });
  const auto vector = [&](const Vec3& value) { pack.vector(value); };
  pack.list(state.velocity, vector);
  pack.list(state.spin, vector);
  pack.list(checkpoint.contacts, [&](const ContactPoint& contact) {
    pack.number(std::int32_t{contact.body_a});
    pack.number(std::int32_t{contact.body_b});
    pack.number(contact.feature);
    pack.vector(contact.normal);
    pack.vector(contact.position);
    pack.number(contact.gap);
  });
  pack.list(checkpoint.impulses, vector);
  pack.list(checkpoint.numbers, [&](double value) { pack.number(value); });
  return std::move(pack.bytes);
}

Checkpoint unpack_body(std::string_view body, const std::filesystem::path& file) {
  Unpacker unpack(body, file);
  Checkpoint checkpoint;
  checkpoint.key = unpack.text();
  checkpoint.phase = unpack.text();
  MotionState& state = checkpoint.state;
  state.time = unpack.number<double>();
  state.step = static_cast<long>(unpack.number<std::int64_t>());
  unpack.list(state.pose, 56, [&] {
    Pose pose;
    pose.position = unpack.vector();
    const auto w = unpack.number<double>();
    const Vec3 xyz = unpack.vector();
    pose.rotation = Quat(w, xyz.x(), xyz.y(), xyz.z());
    return pose;
  });
  const auto vector = [&] { return unpack.vector(); };
  unpack.list(state.velocity, 24, vector);
  unpack.list(state.spin, 24, vector);
  unpack.list(checkpoint.contacts, 72, [&] {
    ContactPoint contact;
    contact.body_a = unpack.number<std::int32_t>();
    contact.body_b = unpack.number<std::int32_t>();
    contact.feature = unpack.number<std::uint64_t>();
    contact.normal = unpack.vector();
    contact.position = unpack.vector();
    contact.gap = unpack.number<double>();
    return contact;
  });
  unpack.list(checkpoint.impulses, 24, vector);
  unpack.list(checkpoint.numbers, 8, [&] { return unpack.number<double>(); });
  unpack.end();
  unpack.same(state.velocity.size(), state.pose.size());
  unpack.same(state.spin.size(), state.pose.size());
  unpack.same(checkpoint.impulses.size(), checkpoint.contacts.size());
  return checkpoint;
}

}  // namespace

void write_checkpoint(const std::filesystem::path& file, const Checkpoint& checkpoint) {
  const std::string body = pack_body(checkpoint);
  Packer pack;
  pack.bytes = magic;
  pack.number(version);
  pack.number(byte_order);
  pack.number(std::uint64_t{body.size()});
  pack.bytes += body;
  pack.number(fnv1a(pack.bytes));
  write_whole_file(file, pack.bytes);
}

Checkpoint read_checkpoint(const std::filesystem::path& file) {
  const std::string bytes = read_whole_file(file);
  const auto refuse = [&](const std::string& why) { throw Error(file.string() + ": " + why); };
  const auto head = [&]<class Number>(size_t at, Number) {
    Number value;
    std::memcpy(&value, bytes.data() + at, sizeof value);
    return value;
  };
  if (bytes.empty()) refuse("checkpoint is empty");
  if (std::string_view(bytes).substr(0, magic.size()) != magic.substr(0, bytes.size()))
    refuse("is not a checkpoint");
  if (bytes.size() < head_bytes)
    refuse("checkpoint is truncated in its first " + std::to_string(head_bytes) + " bytes");
  if (head(12, std::uint32_t{}) != byte_order)
    refuse("checkpoint was written on a machine of another byte order");
  if (const auto found = head(8, std::uint32_t{}); found != version)
    refuse("checkpoint has format " + std::to_string(found) + ", this program reads format " +
           std::to_string(version));
  const std::uint64_t body = head(16, std::uint64_t{}), rest = bytes.size() - head_bytes;
  if (rest < checksum_bytes || body > rest - checksum_bytes)
    refuse("checkpoint is truncated: " + std::to_string(bytes.size()) + " bytes are there");
  if (body < rest - checksum_bytes) refuse("checkpoint is damaged: bytes follow its end");
  const std::string_view summed(bytes.data(), bytes.size() - checksum_bytes);
  if (head(summed.size(), std::uint64_t{}) != fnv1a(summed))
    refuse("checkpoint is damaged: its checksum is wrong");
  return unpack_body(summed.substr(head_bytes), file);
}

}  // namespace ballast
