#include "platform/hdf5_reader.hpp"

#include <hdf5.h>

#include "platform/file_kind.hpp"

namespace ballast {
namespace {

hid_t open_for_reading(const Hdf5File& file, const std::filesystem::path& path) {
  if (!is_file(path)) file.fail(is_there(path) ? "not a regular file" : "no such file");
  // The signature first, so that a text file and a truncated HDF5 file get different answers.
  if (H5Fis_hdf5(path.c_str()) <= 0) file.fail("not an HDF5 file");
  const hid_t id = H5Fopen(path.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT);
  if (id < 0) file.fail("damaged or truncated HDF5 file");
  return id;
}

}  // namespace

Hdf5Reader::Hdf5Reader(const std::filesystem::path& file)
    : Hdf5File(file), file_(open_for_reading(*this, file), H5Fclose) {}

/// Asks group after group: HDF5 fails on a path whose parent is missing.
bool Hdf5Reader::has(const std::string& name) const {
  for (size_t end = name.find('/', 1);; end = name.find('/', end + 1)) {
    if (H5Lexists(file_, name.substr(0, end).c_str(), H5P_DEFAULT) <= 0) return false;
    if (end == std::string::npos) return true;
  }
}

Hdf5Id Hdf5Reader::open(const std::string& name) const {
  if (!has(name)) fail(name + ": no such dataset");
  Hdf5Id dataset(H5Dopen2(file_, name.c_str(), H5P_DEFAULT), H5Dclose);
  if (dataset < 0) fail(name + ": not a dataset");
  return dataset;
}

Hdf5Shape Hdf5Reader::shape(const std::string& name) const {
  const Hdf5Id dataset = open(name), space(H5Dget_space(dataset), H5Sclose);
  Hdf5Shape shape(
      static_cast<size_t>(check(H5Sget_simple_extent_ndims(space), "give the shape of " + name)));
  H5Sget_simple_extent_dims(space, shape.data(), nullptr);
  return shape;
}

/// Before memory is asked for: a damaged header can claim any number of entries. What is stored of
/// them is part of the file, and no compression of HDF5's makes it more than 1032 times smaller.
void Hdf5Reader::require_stored(const std::string& name, const Hdf5Id& dataset,
                                unsigned long long entries) const {
  constexpr unsigned long long most_compressed = 1032;
  const unsigned long long stored = H5Dget_storage_size(dataset);
  std::error_code error;
  const std::uintmax_t file = std::filesystem::file_size(path_, error);
  if (error || stored > file || entries > (stored + 1) * most_compressed)
    fail(name + ": claims " + std::to_string(entries) + " entries, of which " +
         std::to_string(stored) + " bytes are stored");
}

template <typename Value>
std::vector<Value> Hdf5Reader::read(const std::string& name, std::int64_t type) const {
  // What is stored may have any width or byte order: HDF5 converts it to `type` while reading.
  const Hdf5Id dataset = open(name), space(H5Dget_space(dataset), H5Sclose),
               stored(H5Dget_type(dataset), H5Tclose);
  const H5T_class_t kind = stored >= 0 ? H5Tget_class(stored) : H5T_NO_CLASS;
  if (kind != H5T_INTEGER && kind != H5T_FLOAT) fail(name + ": does not hold numbers");
  const hssize_t size = space >= 0 ? H5Sget_simple_extent_npoints(space) : -1;
  if (size < 0) fail(name + ": has no readable extent");
  require_stored(name, dataset, static_cast<unsigned long long>(size));
  std::vector<Value> values(static_cast<size_t>(size));
  if (size > 0 && H5Dread(dataset, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data()) < 0)
    fail(name + ": cannot be read (damaged or truncated)");
  return values;
}

std::vector<double> Hdf5Reader::read_doubles(const std::string& name) const {
  return read<double>(name, H5T_NATIVE_DOUBLE);
}

std::vector<int> Hdf5Reader::read_ints(const std::string& name) const {
  return read<int>(name, H5T_NATIVE_INT);
}

std::vector<std::uint64_t> Hdf5Reader::read_keys(const std::string& name) const {
  return read<std::uint64_t>(name, H5T_NATIVE_UINT64);
}

int Hdf5Reader::read_int(const std::string& name) const {
  const std::vector<int> values = read_ints(name);
  if (values.size() != 1)
    fail(name + " has " + std::to_string(values.size()) + " entries, must have 1");
  return values[0];
}

std::string Hdf5Reader::read_text(const std::string& name) const {
  const Hdf5Id dataset = open(name), type(H5Dget_type(dataset), H5Tclose);
  if (type < 0 || H5Tget_class(type) != H5T_STRING || H5Tis_variable_str(type) != 0)
    fail(name + ": is no text of fixed length");
  const Hdf5Id space(H5Dget_space(dataset), H5Sclose);
  if (space < 0 || H5Sget_simple_extent_npoints(space) != 1) fail(name + ": is not one text");
  // The stored length may include a zero at the end.
  require_stored(name, dataset, H5Tget_size(type));
  std::string text(H5Tget_size(type), '\0');
  if (H5Dread(dataset, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, text.data()) < 0)
    fail(name + ": cannot be read (damaged or truncated)");
  return text.substr(0, text.find('\0'));
}

std::vector<double> Hdf5Reader::read_rows(const std::string& name, size_t first,
                                          size_t count) const {
  const Hdf5Id dataset = open(name), space(H5Dget_space(dataset), H5Sclose);
  const std::string what =
      "read rows " + std::to_string(first) + " to " + std::to_string(first + count) + " of " + name;
  Hdf5Shape of_row = shape(name);
  if (!of_row.empty()) of_row[0] = 1;
  const Hdf5Shape rows = select_rows(space, first, count * product(of_row));
  if (rows.empty()) fail("HDF5 cannot " + what);
  require_stored(name, dataset, product(rows));
  std::vector<double> values(product(rows));
  const Hdf5Id memory = space_of(rows);
  check(H5Dread(dataset, H5T_NATIVE_DOUBLE, memory, space, H5P_DEFAULT, values.data()), what);
  return values;
}

std::vector<std::string> Hdf5Reader::read_texts(const std::string& name) const {
  const Hdf5Id dataset = open(name), type = text_type(), space(H5Dget_space(dataset), H5Sclose);
  const unsigned long long count = product(shape(name));
  require_stored(name, dataset, count);
  std::vector<char*> pointers(count, nullptr);
  check(H5Dread(dataset, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, pointers.data()), "read " + name);
  // HDF5 allocated each text: copied, then given back to it.
  std::vector<std::string> texts(pointers.begin(), pointers.end());
  H5Dvlen_reclaim(type, space, H5P_DEFAULT, pointers.data());
  return texts;
}

}  // namespace ballast
