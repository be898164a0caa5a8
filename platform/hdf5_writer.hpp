#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "platform/hdf5_file.hpp"

namespace ballast {

class Hdf5Disk;

/// How larger datasets are stored: as they are, or compressed and with a checksum.
enum class Hdf5Storage { plain, compressed };

/// How numbers that are given as doubles are stored.
enum class Hdf5Number { float64, int32, int64 };

/// Writes an HDF5 file beside its target, which is replaced by commit(). The format is HDF5 1.8's,
/// with checksums of metadata, and without times of day: equal contents are equal bytes.
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

  /// A dataset that is filled bit by bit: rows are what one number along its first dimension names.
  Hdf5Id add_rows(const std::string& name, const Hdf5Shape& shape,
                  Hdf5Number number = Hdf5Number::float64);
  /// Whole rows, from row `first` on.
  void write_rows(const Hdf5Id& dataset, size_t first, std::span<const double> values);

  /// Makes the file safe on disk and renames it over the target. All datasets handed out must be
  /// closed by then; nothing can be added afterwards.
  void commit();

 private:
  /// What the disk failed with goes before what HDF5 failed with.
  std::int64_t check(std::int64_t result, const std::string& action) const;
  /// `id`, which is closed where that throws.
  Hdf5Id made(Hdf5Id id, const std::string& name) const;
  Hdf5Id make_dataset(const std::string& name, std::int64_t type, const Hdf5Shape& shape,
                      Hdf5Storage storage);
  void write(const std::string& name, std::int64_t stored, std::int64_t given, const void* values,
             const Hdf5Shape& shape);

  Hdf5Storage storage_;
  std::shared_ptr<Hdf5Disk> disk_;
  Hdf5Id file_;
};

}  // namespace ballast
