#include "platform/hdf5_disk.hpp"

#include <hdf5.h>

#include <algorithm>
#include <limits>

namespace ballast {

namespace {

using Disk = std::shared_ptr<Hdf5Disk>;

/// A file as HDF5 has it open. `given`: up to where HDF5 has given the file's addresses away;
/// `length`: up to where something was written.
struct OpenFile : H5FD_t {
  Disk disk;
  haddr_t given = 0, length = 0;
};
OpenFile& of(H5FD_t* file) { return *static_cast<OpenFile*>(file); }
const OpenFile& of(const H5FD_t* file) { return *static_cast<const OpenFile*>(file); }

H5FD_t* open_file(const char*, unsigned, hid_t access, haddr_t) {
  auto* file = new OpenFile();
  file->disk = **static_cast<const Disk* const*>(H5Pget_driver_info(access));
  return file;
}

herr_t close_file(H5FD_t* file) {
  delete &of(file);
  return 0;
}

herr_t read_file(H5FD_t* file, H5FD_mem_t, hid_t, haddr_t offset, size_t size, void* buffer) {
  of(file).disk->read(offset, {static_cast<char*>(buffer), size});
  return 0;
}

herr_t write_file(H5FD_t* file, H5FD_mem_t, hid_t, haddr_t offset, size_t size,
                  const void* buffer) {
  of(file).disk->write(offset, {static_cast<const char*>(buffer), size});
  of(file).length = std::max<haddr_t>(of(file).length, offset + size);
  return 0;
}

/// The file ends where the last address was given away.
herr_t end_file(H5FD_t* file, hid_t, hbool_t) {
  if (of(file).length != of(file).given) of(file).disk->set_length(of(file).given);
  of(file).length = of(file).given;
  return 0;
}

/// The way HDF5 shares room out is that of its own drivers for single files.
herr_t tell_features(const H5FD_t*, unsigned long* features) {
  *features = H5FD_FEAT_AGGREGATE_METADATA | H5FD_FEAT_ACCUMULATE_METADATA | H5FD_FEAT_DATA_SIEVE |
              H5FD_FEAT_AGGREGATE_SMALLDATA;
  return 0;
}

hid_t register_driver() {
  H5FD_class_t driver{};
  driver.name = "ballast";
  driver.maxaddr = std::numeric_limits<std::int64_t>::max();
  driver.fc_degree = H5F_CLOSE_WEAK;
  driver.fapl_size = sizeof(const Disk*);
  driver.open = open_file;
  driver.close = close_file;
  driver.query = tell_features;
  driver.get_eoa = [](const H5FD_t* file, H5FD_mem_t) { return of(file).given; };
  driver.set_eoa = [](H5FD_t* file, H5FD_mem_t, haddr_t end) -> herr_t {
    of(file).given = end;
    return 0;
  };
  driver.get_eof = [](const H5FD_t* file, H5FD_mem_t) { return of(file).length; };
  driver.read = read_file;
  driver.write = write_file;
  driver.truncate = end_file;
  constexpr H5FD_mem_t room[] = H5FD_FLMAP_DICHOTOMY;
  std::ranges::copy(room, driver.fl_map);
  return H5FDregister(&driver);
}

}  // namespace

std::int64_t Hdf5Disk::create_file(const Disk& disk) {
  static const hid_t driver = register_driver();
  const hid_t access = H5Pcreate(H5P_FILE_ACCESS), creation = H5Pcreate(H5P_FILE_CREATE);
  const Disk* order = &disk;
  H5Pset_driver(access, driver, &order);
  H5Pset_libver_bounds(access, H5F_LIBVER_V18, H5F_LIBVER_LATEST);
  H5Pset_obj_track_times(creation, false);
  const hid_t file = H5Fcreate("on our disk", H5F_ACC_TRUNC, creation, access);
  H5Pclose(access);
  H5Pclose(creation);
  return file;
}

void Hdf5Disk::commit() {
  require_written();
  file_.commit();
}

template <class Work>
void Hdf5Disk::attempt(const Work& work) {
  try {
    work();
  } catch (...) {
    if (!failure_) failure_ = std::current_exception();
  }
}

void Hdf5Disk::write(std::uint64_t offset, std::string_view bytes) {
  if (!failure_) attempt([&] { file_.write_at(offset, bytes); });
}

void Hdf5Disk::read(std::uint64_t offset, std::span<char> bytes) {
  attempt([&] { file_.read_at(offset, bytes); });
}

void Hdf5Disk::set_length(std::uint64_t bytes) {
  attempt([&] { file_.set_length(bytes); });
}

}  // namespace ballast
