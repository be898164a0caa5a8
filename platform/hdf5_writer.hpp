#pragma once

#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "platform/hdf5_file.hpp"

namespace ballast {

/// How larger datasets are stored: as they are, or compressed and with a checksum.
enum class Hdf5Storage { plain, compressed };

/// Builds an HDF5 file in memory and writes it to disk whole: HDF5 cannot recover from a disk that
/// fills up while it writes. The format is HDF5 1.8's, with checksums of metadata, and without
/// times of day: equal contents are equal bytes.
class Hdf5Writer : public Hdf5File {
 public:
  Hdf5Writer(const std::filesystem::path& target, Hdf5Storage storage);

  void add_group(const std::string& name);
  /// Attribute of a group or dataset; "/" is the file.
  void add_attribute(const std::string& object, const std::string& attribute,
                     const std::string& text);

  void add(const std::string& name, std::span<const double> values, const Hdf5Shape& shape);
  void add(const std::string& name, std::span<const std::int32_t> values, const Hdf5Shape& shape);
  void add(const std::string& name, std::span<const std::int64_t> values, const Hdf5Shape& shape);
  void add(const std::string& name, std::span<const std::uint64_t> values, const Hdf5Shape& shape);
  /// One dimension.
  template <typename Value>
  void add(const std::string& name, const std::vector<Value>& values) {
    add(name, std::span<const Value>(values), {values.size()});
  }
  void add(const std::string& name, const std::vector<std::string>& texts);
  /// One text, stored with its length.
  void add_text(const std::string& name, const std::string& text);

  /// A dataset of doubles that is filled slice by slice along its first dimension.
  Hdf5Id add_slices(const std::string& name, const Hdf5Shape& shape);
  void write_slice(const Hdf5Id& dataset, size_t index, std::span<const double> values);

  /// Writes beside the target and renames. All datasets handed out must be closed by then; nothing
  /// can be added afterwards.
  void commit();

  /// The bytes of the file in memory, which HDF5 leaves to us when it closes the file.
  struct Image {
    unsigned char* bytes = nullptr;
    ~Image();
  };

 private:
  Hdf5Id make_dataset(const std::string& name, std::int64_t type, const Hdf5Shape& shape,
                      Hdf5Storage storage);
  void write(const std::string& name, std::int64_t stored, std::int64_t given, const void* values,
             const Hdf5Shape& shape);

  Hdf5Storage storage_;
  Image image_;  // outlives file_
  Hdf5Id file_;
};

}  // namespace ballast
