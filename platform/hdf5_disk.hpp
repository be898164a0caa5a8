#pragma once
// The disk as HDF5 sees it while it makes a file: one that never fills up. HDF5 cannot recover from
// a write that fails: its handles would stay open, and the end of the program would try again. So
// it is told that every write went well; the first failure is kept and thrown to whoever asks.

#include <cstdint>
#include <exception>
#include <filesystem>
#include <memory>
#include <span>
#include <string_view>

#include "platform/atomic_file.hpp"

namespace ballast {

class Hdf5Disk {
 public:
  explicit Hdf5Disk(const std::filesystem::path& target) : file_(target) {}

  /// Makes an HDF5 file whose bytes go to `disk`, without times of day: equal contents are equal
  /// bytes. Returns its handle (hid_t), negative when HDF5 fails.
  static std::int64_t create_file(const std::shared_ptr<Hdf5Disk>& disk);

  /// Throws the Error with which a write failed.
  void require_written() const {
    if (failure_) std::rethrow_exception(failure_);
  }
  /// The file takes its name. Its handle must be closed by then.
  void commit();

  // What HDF5 asks for. After a failure nothing is written any more.
  void write(std::uint64_t offset, std::string_view bytes);
  void read(std::uint64_t offset, std::span<char> bytes);
  void set_length(std::uint64_t bytes);

 private:
  /// Keeps the first failure.
  template <class Work>
  void attempt(const Work& work);

  AtomicFile file_;
  std::exception_ptr failure_;
};

}  // namespace ballast
