#include "problems/files/hdf5_arrays.hpp"

#include <hdf5.h>

#include <utility>

#include "problems/files/problem_file_error.hpp"

namespace ballast {
namespace {

static_assert(sizeof(hid_t) == sizeof(std::int64_t));

/// Closes an HDF5 handle of any kind.
class Handle {
 public:
  Handle(hid_t id, herr_t (*close)(hid_t)) : id_(id), close_(close) {}
  ~Handle() {
    if (id_ >= 0) close_(id_);
  }
  Handle(const Handle&) = delete;
  Handle& operator=(const Handle&) = delete;
  hid_t id() const { return id_; }
  bool valid() const { return id_ >= 0; }

 private:
  hid_t id_;
  herr_t (*close_)(hid_t);
};

}  // namespace

Hdf5Arrays::Hdf5Arrays(const std::filesystem::path& file, Mode mode) : name_(file.string()) {
  H5Eget_auto2(H5E_DEFAULT, &old_report_, &old_client_);
  H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);
  std::string problem;
  if (mode == Mode::create) {
    file_ = H5Fcreate(name_.c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, H5P_DEFAULT);
    problem = "cannot be created";
  } else if (!std::filesystem::is_regular_file(file)) {
    problem = "no such file";
  } else if (H5Fis_hdf5(name_.c_str()) <= 0) {
    problem = "not an HDF5 file";
  } else {
    file_ =
        H5Fopen(name_.c_str(), mode == Mode::extend ? H5F_ACC_RDWR : H5F_ACC_RDONLY, H5P_DEFAULT);
    problem = "damaged or truncated HDF5 file";
  }
  if (file_ >= 0) return;
  H5Eset_auto2(H5E_DEFAULT, old_report_, old_client_);
  fail(problem);
}

Hdf5Arrays::~Hdf5Arrays() {
  if (file_ >= 0) H5Fclose(file_);
  H5Eset_auto2(H5E_DEFAULT, old_report_, old_client_);
}

void Hdf5Arrays::close() {
  const bool flushed = H5Fflush(file_, H5F_SCOPE_GLOBAL) >= 0;
  const bool closed = H5Fclose(std::exchange(file_, -1)) >= 0;
  if (!flushed || !closed) fail("cannot be written to the end");
}

void Hdf5Arrays::fail(const std::string& what) const {
  throw ProblemFileError(name_ + ": " + what);
}

/// Asks group after group: HDF5 fails on a path whose parent is missing.
bool Hdf5Arrays::has(const std::string& path) const {
  for (std::size_t end = path.find('/', 1);; end = path.find('/', end + 1)) {
    if (H5Lexists(file_, path.substr(0, end).c_str(), H5P_DEFAULT) <= 0) return false;
    if (end == std::string::npos) return true;
  }
}

template <typename Value>
std::vector<Value> Hdf5Arrays::read(const std::string& path, std::int64_t type) const {
  if (!has(path)) fail(path + ": no such dataset");
  const Handle dataset(H5Dopen2(file_, path.c_str(), H5P_DEFAULT), H5Dclose);
  if (!dataset.valid()) fail(path + ": not a dataset");
  const Handle space(H5Dget_space(dataset.id()), H5Sclose);
  const Handle stored(H5Dget_type(dataset.id()), H5Tclose);
  const H5T_class_t kind = stored.valid() ? H5Tget_class(stored.id()) : H5T_NO_CLASS;
  if (kind != H5T_INTEGER && kind != H5T_FLOAT) fail(path + ": does not hold numbers");
  const hssize_t size = space.valid() ? H5Sget_simple_extent_npoints(space.id()) : -1;
  // More entries than fit into a file of the largest sensible size: a damaged header, not a
  // dataset.
  if (size < 0 || size > (hssize_t{1} << 31)) fail(path + ": has no readable extent");
  std::vector<Value> values(static_cast<std::size_t>(size));
  if (size > 0 && H5Dread(dataset.id(), type, H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data()) < 0)
    fail(path + ": cannot be read (damaged or truncated)");
  return values;
}

std::vector<int> Hdf5Arrays::read_ints(const std::string& path) const {
  return read<int>(path, H5T_NATIVE_INT);
}

std::vector<double> Hdf5Arrays::read_doubles(const std::string& path) const {
  return read<double>(path, H5T_NATIVE_DOUBLE);
}

std::vector<std::uint64_t> Hdf5Arrays::read_keys(const std::string& path) const {
  return read<std::uint64_t>(path, H5T_NATIVE_UINT64);
}

std::string Hdf5Arrays::read_text(const std::string& path) const {
  if (!has(path)) fail(path + ": no such dataset");
  const Handle dataset(H5Dopen2(file_, path.c_str(), H5P_DEFAULT), H5Dclose);
  const Handle type(dataset.valid() ? H5Dget_type(dataset.id()) : H5I_INVALID_HID, H5Tclose);
  if (!type.valid() || H5Tget_class(type.id()) != H5T_STRING || H5Tis_variable_str(type.id()) != 0)
    fail(path + ": is no text of fixed length");
  const Handle space(H5Dget_space(dataset.id()), H5Sclose);
  if (!space.valid() || H5Sget_simple_extent_npoints(space.id()) != 1)
    fail(path + ": is not one text");
  std::string text(H5Tget_size(type.id()), '\0');
  if (H5Dread(dataset.id(), type.id(), H5S_ALL, H5S_ALL, H5P_DEFAULT, text.data()) < 0)
    fail(path + ": cannot be read (damaged or truncated)");
  return text.substr(0, text.find('\0'));
}

int Hdf5Arrays::read_int(const std::string& path) const {
  const std::vector<int> values = read_ints(path);
  if (values.size() != 1)
    fail(path + " has " + std::to_string(values.size()) + " entries, must have 1");
  return values[0];
}

void Hdf5Arrays::make_group(const std::string& path) {
  const Handle group(H5Gcreate2(file_, path.c_str(), H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT),
                     H5Gclose);
  if (!group.valid()) fail(path + ": cannot be written");
}

void Hdf5Arrays::write(const std::string& path, std::int64_t type, std::uint64_t size,
                       const void* values) {
  const hsize_t extent = size;
  const Handle space(H5Screate_simple(1, &extent, nullptr), H5Sclose);
  const Handle dataset(
      H5Dcreate2(file_, path.c_str(), type, space.id(), H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT),
      H5Dclose);
  if (!dataset.valid() ||
      (size > 0 && H5Dwrite(dataset.id(), type, H5S_ALL, H5S_ALL, H5P_DEFAULT, values) < 0))
    fail(path + ": cannot be written");
}

void Hdf5Arrays::write(const std::string& path, const std::vector<int>& values) {
  write(path, H5T_NATIVE_INT, values.size(), values.data());
}

void Hdf5Arrays::write(const std::string& path, const std::vector<double>& values) {
  write(path, H5T_NATIVE_DOUBLE, values.size(), values.data());
}

void Hdf5Arrays::write(const std::string& path, const std::vector<std::uint64_t>& values) {
  write(path, H5T_NATIVE_UINT64, values.size(), values.data());
}

void Hdf5Arrays::write(const std::string& path, const std::string& text) {
  const Handle type(H5Tcopy(H5T_C_S1), H5Tclose);
  H5Tset_size(type.id(), text.size() + 1);
  write(path, type.id(), 1, text.c_str());
}

}  // namespace ballast
