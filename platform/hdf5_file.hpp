#pragma once
// The little of HDF5's C interface that records and problem files need, without its header. Every
// failure is an Error that begins with the file and names the dataset; HDF5 itself prints nothing.
//
// Why not H5Cpp, which Debian has too: it wraps neither a driver of our own (hdf5_disk.hpp) nor
// the switch that leaves times of day out, so half of the writer would be C all the same; its
// header costs 0.3 s in each includer (this one: none of HDF5's), its library is one more package.

#include <cstdint>
#include <filesystem>
#include <string>
#include <utility>
#include <vector>

namespace ballast {

/// Owns one HDF5 handle (hid_t) and closes it.
class Hdf5Id {
 public:
  using Close = int (*)(std::int64_t);
  Hdf5Id(std::int64_t id, Close closer) : id_(id), close_(closer) {}
  ~Hdf5Id() {
    if (id_ >= 0) close_(id_);
  }
  Hdf5Id(Hdf5Id&& other) noexcept : id_(std::exchange(other.id_, -1)), close_(other.close_) {}
  Hdf5Id& operator=(Hdf5Id&&) = delete;
  operator std::int64_t() const { return id_; }
  /// Closes it now; negative when that fails.
  int close() { return close_(std::exchange(id_, -1)); }

 private:
  std::int64_t id_;
  Close close_;
};

/// Sizes along the dimensions (hsize_t).
using Hdf5Shape = std::vector<unsigned long long>;

/// What Hdf5Reader and Hdf5Writer share: the name for errors, and silence while they live.
class Hdf5File {
 public:
  /// Throws Error "<file>: <what>".
  [[noreturn]] void fail(const std::string& what) const;

 protected:
  explicit Hdf5File(const std::filesystem::path& path);
  ~Hdf5File();
  Hdf5File(const Hdf5File&) = delete;
  Hdf5File& operator=(const Hdf5File&) = delete;
  /// `result`, unless it is negative: then Error "<file>: HDF5 cannot <action>".
  std::int64_t check(std::int64_t result, const std::string& action) const;

  /// UTF-8 of any length.
  static Hdf5Id text_type();
  /// The space of an array of that shape.
  static Hdf5Id space_of(const Hdf5Shape& shape);
  /// Selects as many entries of `space` as whole rows along its first dimension, from row `first`
  /// on, and returns their shape; empty when there are no such rows.
  static Hdf5Shape select_rows(const Hdf5Id& space, size_t first, size_t entries);
  /// Number of entries.
  static unsigned long long product(const Hdf5Shape& shape);

  const std::filesystem::path path_;

 private:
  int (*old_report_)(std::int64_t, void*) = nullptr;  // how HDF5 spoke of errors before us
  void* old_client_ = nullptr;
};

}  // namespace ballast
