#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "platform/hdf5_file.hpp"

namespace ballast {

/// Reads an HDF5 file, whoever wrote it. Numbers are converted from whatever type they have.
class Hdf5Reader : public Hdf5File {
 public:
  explicit Hdf5Reader(const std::filesystem::path& file);

  bool has(const std::string& name) const;
  Hdf5Shape shape(const std::string& name) const;
  std::vector<double> read_doubles(const std::string& name) const;
  std::vector<int> read_ints(const std::string& name) const;
  std::vector<std::uint64_t> read_keys(const std::string& name) const;
  /// The only entry of a dataset.
  int read_int(const std::string& name) const;
  /// As Hdf5Writer::add_text left it.
  std::string read_text(const std::string& name) const;
  /// `count` rows from row `first` on: what one number along the first dimension names is a row.
  std::vector<double> read_rows(const std::string& name, size_t first, size_t count = 1) const;
  std::vector<std::string> read_texts(const std::string& name) const;

 private:
  Hdf5Id open(const std::string& name) const;
  void require_stored(const std::string& name, const Hdf5Id& dataset,
                      unsigned long long entries) const;
  template <typename Value>
  std::vector<Value> read(const std::string& name, std::int64_t type) const;

  Hdf5Id file_;
};

}  // namespace ballast
