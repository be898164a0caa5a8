#pragma once
// Converts values to bytes and back, for files and for answers of child processes. One template on
// the carrier lists the members and serves both directions, so that reading matches writing:
//
//   template <class Carrier, class State>
//   void carry(Carrier& carrier, State& state) {
//     carrier.numbers(state.time, state.step);
//     carrier.text(state.name);
//     carrier.list(state.spin, [&](auto& spin) { carrier.fixed(spin); });
//   }
//
//   Packer packer;                                Unpacker unpacker(bytes, file + ": checkpoint");
//   carry(packer, state);                         carry(unpacker, state);
//   write_whole_file(file, packer.bytes());       unpacker.finish();
//
// Numbers have this machine's size and byte order. Texts and lists begin with their length, 64
// bits.

#include <cstdint>
#include <cstring>
#include <filesystem>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>

#include "platform/error.hpp"

namespace ballast {

class Packer {
 public:
  /// Any arithmetic type or enum.
  template <class Number>
  void number(const Number& value) {
    static_assert(std::is_arithmetic_v<Number> || std::is_enum_v<Number>);
    bytes_.append(reinterpret_cast<const char*>(&value), sizeof value);
  }
  template <class... Numbers>
  void numbers(const Numbers&... values) {
    (..., number(values));
  }
  void text(const std::string& value) {
    length(value.size());
    bytes_ += value;
  }
  /// Numbers whose count both sides know: a vector of three, an array.
  template <class Numbers>
  void fixed(const Numbers& values) {
    for (const auto& value : values) number(value);
  }
  /// Numbers whose count is packed too: std::vector or Eigen::VectorXd.
  template <class Numbers>
  void list(const Numbers& values) {
    length(static_cast<std::size_t>(values.size()));
    fixed(values);
  }
  /// A list whose entries `each(entry)` carries.
  template <class List, class Each>
  void list(const List& values, Each&& each) {
    length(values.size());
    for (const auto& value : values) each(value);
  }

  const std::string& bytes() const { return bytes_; }

 private:
  void length(std::size_t count) { number(std::uint64_t{count}); }

  std::string bytes_;
};

/// Takes values from `bytes`, which must outlive it, in the order in which they were packed.
/// Nothing is read or allocated beyond the bytes that are there: where bytes are missing it throws
/// Error "<origin> is inconsistent: a list has a wrong length".
class Unpacker {
 public:
  Unpacker(std::string_view bytes, std::string origin) : rest_(bytes), origin_(std::move(origin)) {}

  template <class Number>
  void number(Number& value) {
    static_assert(std::is_arithmetic_v<Number> || std::is_enum_v<Number>);
    if constexpr (std::is_same_v<Number, bool>)
      value = *take(1).data() != 0;
    else
      std::memcpy(&value, take(sizeof value).data(), sizeof value);
  }
  template <class... Numbers>
  void numbers(Numbers&... values) {
    (..., number(values));
  }
  void text(std::string& value) { value = take(length(1)); }
  template <class Numbers>
  void fixed(Numbers& values) {
    for (auto& value : values) number(value);
  }
  template <class Numbers>
  void list(Numbers& values) {
    values.resize(static_cast<decltype(values.size())>(length(sizeof(*values.data()))));
    fixed(values);
  }
  template <class List, class Each>
  void list(List& values, Each&& each) {
    values.clear();
    for (std::size_t count = length(1); count > 0; --count) each(values.emplace_back());
  }

  /// Checks another condition that the reader knows; throws the same Error when it does not hold.
  void require(bool consistent) const {
    if (!consistent) throw Error(origin_ + " is inconsistent: a list has a wrong length");
  }
  /// Requires that no bytes are left over.
  void finish() const { require(rest_.empty()); }

 private:
  /// The length of a list whose entries take at least `least` bytes each.
  std::size_t length(std::size_t least) {
    std::uint64_t count = 0;
    number(count);
    require(count <= rest_.size() / least);
    return static_cast<std::size_t>(count);
  }
  std::string_view take(std::size_t count) {
    require(count <= rest_.size());
    const std::string_view taken = rest_.substr(0, count);
    rest_.remove_prefix(count);
    return taken;
  }

  std::string_view rest_;
  std::string origin_;
};

// Small binary files that are read whole or refused. They hold their kind, their format and a
// checksum.
//
//   magic (8 letters), u32 format, u32 byte order, u64 bytes of the body, body, u64 checksum
//   (FNV-1a) of all before it

struct SealedKind {
  std::string_view magic;  ///< 8 letters
  std::string_view name;   ///< in messages: "checkpoint"
  std::uint32_t format;    ///< written and read
};

/// Writes to a neighbour, makes that safe on disk and renames it. Throws Error.
void write_sealed_file(const std::filesystem::path& file, const SealedKind& kind,
                       std::string_view body);

/// Returns the body. Throws Error naming the file where it is missing, truncated, of another kind
/// or format, or has a wrong checksum.
std::string read_sealed_file(const std::filesystem::path& file, const SealedKind& kind);

}  // namespace ballast
