#pragma once
// The little of HDF5's C API that records need. Every failure is a Error that names the file; HDF5
// itself says nothing.

#include <hdf5.h>

#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <utility>
#include <vector>

namespace ballast {

/// Owns one HDF5 handle.
class Hdf5Id {
 public:
  using Close = herr_t (*)(hid_t);
  Hdf5Id(hid_t id, Close closer) : id_(id), close_(closer) {}
  ~Hdf5Id() {
    if (id_ >= 0) close_(id_);
  }
  Hdf5Id(Hdf5Id&& other) noexcept : id_(std::exchange(other.id_, -1)), close_(other.close_) {}
  Hdf5Id& operator=(Hdf5Id&&) = delete;
  operator hid_t() const { return id_; }
  herr_t close() { return close_(std::exchange(id_, -1)); }

 private:
  hid_t id_;
  Close close_;
};

/// While alive, HDF5 prints no error stacks.
class Hdf5Silence {
 public:
  Hdf5Silence();
  ~Hdf5Silence();
  Hdf5Silence(const Hdf5Silence&) = delete;
  Hdf5Silence& operator=(const Hdf5Silence&) = delete;

 private:
  H5E_auto2_t function_ = nullptr;
  void* data_ = nullptr;
};

using Hdf5Shape = std::vector<hsize_t>;

/// Builds an HDF5 file in memory and writes it to disk whole: HDF5 cannot recover from a disk that
/// fills up while it writes. The format is HDF5 1.8's, with checksums of metadata and of compressed
/// data, and without times of day: equal contents are equal bytes.
class Hdf5Writer {
 public:
  explicit Hdf5Writer(const std::filesystem::path& target);

  void add_group(const std::string& name);
  /// Attribute of a group or dataset; "/" is the file.
  void add_text(const std::string& object, const std::string& attribute, const std::string& text);

  void add(const std::string& name, std::span<const double> values, const Hdf5Shape& shape);
  void add(const std::string& name, std::span<const std::int32_t> values, const Hdf5Shape& shape);
  void add(const std::string& name, std::span<const std::int64_t> values, const Hdf5Shape& shape);
  void add(const std::string& name, const std::vector<std::string>& texts);

  /// A dataset of doubles that is filled slice by slice along its first dimension.
  Hdf5Id add_slices(const std::string& name, const Hdf5Shape& shape);
  void write_slice(const Hdf5Id& dataset, hsize_t index, std::span<const double> values);

  /// Writes beside the target and renames. All datasets handed out must be closed by then; nothing
  /// can be added afterwards.
  void commit();

  /// The bytes of the file in memory, which HDF5 leaves to us when it closes the file.
  struct Image {
    unsigned char* bytes = nullptr;
    ~Image();
  };

 private:
  Hdf5Id make_dataset(const std::string& name, hid_t type, const Hdf5Shape& shape);
  void write(const std::string& name, hid_t stored, hid_t given, const void* values,
             const Hdf5Shape& shape);
  hid_t check(hid_t result, const std::string& what) const;

  Hdf5Silence silence_;
  std::filesystem::path target_;
  Image image_;  // outlives file_
  Hdf5Id file_;
};

class Hdf5Reader {
 public:
  explicit Hdf5Reader(const std::filesystem::path& file);

  bool has(const std::string& name) const;
  Hdf5Shape shape(const std::string& name) const;
  std::vector<double> read(const std::string& name) const;
  /// Slice `index` along the first dimension.
  std::vector<double> read_slice(const std::string& name, hsize_t index) const;
  std::vector<std::string> read_texts(const std::string& name) const;
  std::string read_text(const std::string& object, const std::string& attribute) const;

 private:
  Hdf5Id open(const std::string& name) const;
  hid_t check(hid_t result, const std::string& what) const;

  Hdf5Silence silence_;
  std::filesystem::path path_;
  Hdf5Id file_;
};

}  // namespace ballast
