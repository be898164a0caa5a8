#include "platform/hdf5_writer.hpp"

#include <hdf5.h>

#include <algorithm>

#include "platform/hdf5_disk.hpp"

namespace ballast {

namespace {

constexpr hsize_t chunk_bytes = 1 << 16;  // of compressed data; a sixteenth is stored as it is
constexpr unsigned deflate_level = 4;

hid_t type_in_file(Hdf5Number number) {
  return number == Hdf5Number::float64 ? H5T_IEEE_F64LE
         : number == Hdf5Number::int32 ? H5T_STD_I32LE
                                       : H5T_STD_I64LE;
}

}  // namespace

Hdf5Writer::Hdf5Writer(const std::filesystem::path& target, Hdf5Storage storage)
    : Hdf5File(target),
      storage_(storage),
      disk_(std::make_shared<Hdf5Disk>(target)),
      file_(Hdf5Disk::create_file(disk_), H5Fclose) {
  check(file_, "make a file");
}

std::int64_t Hdf5Writer::check(std::int64_t result, const std::string& action) const {
  disk_->require_written();
  return Hdf5File::check(result, action);
}

Hdf5Id Hdf5Writer::made(Hdf5Id id, const std::string& name) const {
  check(id, "make " + name);
  return id;
}

void Hdf5Writer::add_group(const std::string& name) {
  const Hdf5Id creation(H5Pcreate(H5P_GROUP_CREATE), H5Pclose);
  H5Pset_obj_track_times(creation, false);
  made({H5Gcreate2(file_, name.c_str(), H5P_DEFAULT, creation, H5P_DEFAULT), H5Gclose}, name);
}

void Hdf5Writer::add_attribute(const std::string& object, const std::string& attribute,
                               const std::string& text) {
  const std::string what = "write the attribute " + attribute + " of " + object;
  const Hdf5Id type = text_type(), space(H5Screate(H5S_SCALAR), H5Sclose);
  const Hdf5Id id(H5Acreate_by_name(file_, object.c_str(), attribute.c_str(), type, space,
                                    H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT),
                  H5Aclose);
  check(id, what);
  const char* value = text.c_str();
  check(H5Awrite(id, type, &value), what);
}

Hdf5Id Hdf5Writer::make_dataset(const std::string& name, std::int64_t type, const Hdf5Shape& shape,
                                Hdf5Storage storage) {
  const Hdf5Id creation(H5Pcreate(H5P_DATASET_CREATE), H5Pclose);
  H5Pset_obj_track_times(creation, false);
  const Hdf5Id access(H5Pcreate(H5P_DATASET_ACCESS), H5Pclose);
  const hsize_t bytes = product(shape) * H5Tget_size(type);
  if (storage == Hdf5Storage::compressed && bytes > chunk_bytes / 16 && !shape.empty()) {
    // Chunks of whole slices, about 64 kB each: shuffled (bytes of equal weight together, which
    // compresses better), compressed, and with a checksum.
    Hdf5Shape chunk = shape;
    chunk[0] = std::clamp<hsize_t>(chunk_bytes * shape[0] / bytes, 1, shape[0]);
    H5Pset_chunk(creation, static_cast<int>(chunk.size()), chunk.data());
    H5Pset_shuffle(creation);
    if (H5Zfilter_avail(H5Z_FILTER_DEFLATE) > 0) H5Pset_deflate(creation, deflate_level);
    H5Pset_fletcher32(creation);
    // Of a dataset that is filled bit by bit so much waits for the rest of its chunk.
    H5Pset_chunk_cache(access, H5D_CHUNK_CACHE_NSLOTS_DEFAULT, 4 * chunk_bytes,
                       H5D_CHUNK_CACHE_W0_DEFAULT);
  }
  const Hdf5Id space = space_of(shape);
  return made(
      {H5Dcreate2(file_, name.c_str(), type, space, H5P_DEFAULT, creation, access), H5Dclose},
      name);
}

void Hdf5Writer::write(const std::string& name, std::int64_t stored, std::int64_t given,
                       const void* values, const Hdf5Shape& shape) {
  const Hdf5Id dataset = make_dataset(name, stored, shape, storage_);
  if (product(shape) > 0)
    check(H5Dwrite(dataset, given, H5S_ALL, H5S_ALL, H5P_DEFAULT, values), "write " + name);
}

void Hdf5Writer::add(const std::string& name, std::span<const double> values,
                     const Hdf5Shape& shape) {
  write(name, H5T_IEEE_F64LE, H5T_NATIVE_DOUBLE, values.data(), shape);
}

void Hdf5Writer::add(const std::string& name, std::span<const std::int32_t> values,
                     const Hdf5Shape& shape) {
  write(name, H5T_STD_I32LE, H5T_NATIVE_INT32, values.data(), shape);
}

void Hdf5Writer::add(const std::string& name, std::span<const std::int64_t> values,
                     const Hdf5Shape& shape) {
  write(name, H5T_STD_I64LE, H5T_NATIVE_INT64, values.data(), shape);
}

void Hdf5Writer::add(const std::string& name, std::span<const std::uint64_t> values,
                     const Hdf5Shape& shape) {
  write(name, H5T_STD_U64LE, H5T_NATIVE_UINT64, values.data(), shape);
}

void Hdf5Writer::add(const std::string& name, const std::vector<std::string>& texts) {
  std::vector<const char*> pointers;
  for (const std::string& text : texts) pointers.push_back(text.c_str());
  const Hdf5Id type = text_type();
  const Hdf5Id dataset = make_dataset(name, type, {texts.size()}, Hdf5Storage::plain);
  if (!texts.empty())
    check(H5Dwrite(dataset, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, pointers.data()), "write " + name);
}

void Hdf5Writer::add_text(const std::string& name, const std::string& text) {
  const Hdf5Id type(H5Tcopy(H5T_C_S1), H5Tclose);
  H5Tset_size(type, text.size() + 1);
  const Hdf5Id dataset = make_dataset(name, type, {1}, Hdf5Storage::plain);
  check(H5Dwrite(dataset, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, text.c_str()), "write " + name);
}

Hdf5Id Hdf5Writer::add_rows(const std::string& name, const Hdf5Shape& shape, Hdf5Number number) {
  return make_dataset(name, type_in_file(number), shape, storage_);
}

void Hdf5Writer::write_rows(const Hdf5Id& dataset, size_t first, std::span<const double> values) {
  const Hdf5Id space(H5Dget_space(dataset), H5Sclose);
  const Hdf5Shape rows = select_rows(space, first, values.size());
  if (rows.empty()) fail("HDF5 cannot select rows");
  const Hdf5Id memory = space_of(rows);
  check(H5Dwrite(dataset, H5T_NATIVE_DOUBLE, memory, space, H5P_DEFAULT, values.data()),
        "write rows");
}

void Hdf5Writer::commit() {
  // Closing makes HDF5 write its last metadata.
  check(file_.close(), "finish the file");
  disk_->commit();
}

}  // namespace ballast
