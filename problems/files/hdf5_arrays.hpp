#pragma once
// An adapter over HDF5's C interface: one-dimensional arrays of integers, doubles and 64-bit keys
// by path, errors as one line.

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace ballast {

/// An open HDF5 file; handles are closed by the destructor, and HDF5's own error printing is off
/// while it lives. Every failure is a ProblemFileError that starts with the file's name and names
/// the dataset.
class Hdf5Arrays {
 public:
  enum class Mode { read, create, extend };

  Hdf5Arrays(const std::filesystem::path& file, Mode mode);
  ~Hdf5Arrays();
  Hdf5Arrays(const Hdf5Arrays&) = delete;
  Hdf5Arrays& operator=(const Hdf5Arrays&) = delete;

  bool has(const std::string& path) const;
  std::vector<int> read_ints(const std::string& path) const;
  std::vector<double> read_doubles(const std::string& path) const;
  std::vector<std::uint64_t> read_keys(const std::string& path) const;
  std::string read_text(const std::string& path) const;  ///< as write() left it
  int read_int(const std::string& path) const;           ///< the only entry of a dataset

  void make_group(const std::string& path);
  void write(const std::string& path, const std::vector<int>& values);
  void write(const std::string& path, const std::vector<double>& values);
  void write(const std::string& path, const std::vector<std::uint64_t>& values);
  void write(const std::string& path, const std::string& text);
  /// Flushes and closes; a full disk is noticed here.
  void close();

  [[noreturn]] void fail(const std::string& what) const;

 private:
  template <typename Value>
  std::vector<Value> read(const std::string& path, std::int64_t type) const;
  void write(const std::string& path, std::int64_t type, std::uint64_t size, const void* values);

  std::string name_;
  std::int64_t file_ = -1;  ///< hid_t, kept out of the header
  void* old_client_ = nullptr;
  int (*old_report_)(std::int64_t, void*) = nullptr;
};

}  // namespace ballast
