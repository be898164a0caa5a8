#include "platform/hdf5_writer.hpp"

#include <hdf5.h>

#include <algorithm>
#include <cstdlib>
#include <cstring>

#include "platform/atomic_file.hpp"

namespace ballast {

namespace {

constexpr size_t memory_increment = size_t{1} << 18;  // by which the file in memory grows; zeroed
constexpr hsize_t chunk_bytes = 1 << 16;  // of compressed data; a sixteenth is stored as it is
constexpr unsigned deflate_level = 4;

/// Memory of a file in memory: malloc's, but kept when the file is closed. H5Fget_file_image would
/// copy it, and spoils the checksum of the superblock (HDF5 1.10).
namespace image_memory {
using Op = H5FD_file_image_op_t;
void* allocate(size_t size, Op, void*) { return std::malloc(size); }
void* copy(void* to, const void* from, size_t size, Op, void*) {
  return std::memcpy(to, from, size);
}
void* resize(void* bytes, size_t size, Op, void*) { return std::realloc(bytes, size); }
herr_t release(void* bytes, Op op, void* image) {
  if (op == H5FD_FILE_IMAGE_OP_FILE_CLOSE)
    static_cast<Hdf5Writer::Image*>(image)->bytes = static_cast<unsigned char*>(bytes);
  else
    std::free(bytes);
  return 0;
}
void* same_image(void* image) { return image; }
herr_t keep_image(void*) { return 0; }
}  // namespace image_memory

/// Opens a file that lives in memory only: its name is never used.
hid_t create_in_memory(Hdf5Writer::Image& image) {
  const Hdf5Id access(H5Pcreate(H5P_FILE_ACCESS), H5Pclose),
      creation(H5Pcreate(H5P_FILE_CREATE), H5Pclose);
  H5FD_file_image_callbacks_t callbacks{image_memory::allocate,    image_memory::copy,
                                        image_memory::resize,      image_memory::release,
                                        image_memory::same_image,  image_memory::keep_image,
                                        static_cast<void*>(&image)};
  // Nothing of it is on the disk before commit(), and no times of day are kept:
  // equal records are equal files.
  H5Pset_fapl_core(access, memory_increment, false);
  H5Pset_file_image_callbacks(access, &callbacks);
  H5Pset_libver_bounds(access, H5F_LIBVER_V18, H5F_LIBVER_LATEST);
  H5Pset_obj_track_times(creation, false);
  return H5Fcreate("record in memory", H5F_ACC_TRUNC, creation, access);
}

/// Length of a file with superblock version 2 (HDF5 1.8's): its end-of-file address. 0 for anything
/// else.
size_t file_length(const unsigned char* bytes) {
  constexpr unsigned char beginning[] = {0x89, 'H', 'D', 'F', '\r', '\n', 0x1a, '\n', 2, 8, 8};
  constexpr size_t end_of_file = 28;
  if (!bytes || std::memcmp(bytes, beginning, sizeof beginning) != 0) return 0;
  size_t length = 0;
  // Little-endian: from the last byte down.
  for (size_t k = 8; k-- > 0;) length = length << 8 | bytes[end_of_file + k];
  return length;
}

}  // namespace

Hdf5Writer::Hdf5Writer(const std::filesystem::path& target, Hdf5Storage storage)
    : Hdf5File(target),
      storage_(storage),
      file_(check(create_in_memory(image_), "make a file in memory"), H5Fclose) {}

void Hdf5Writer::add_group(const std::string& name) {
  const Hdf5Id creation(H5Pcreate(H5P_GROUP_CREATE), H5Pclose);
  H5Pset_obj_track_times(creation, false);
  const Hdf5Id group(
      check(H5Gcreate2(file_, name.c_str(), H5P_DEFAULT, creation, H5P_DEFAULT), "make " + name),
      H5Gclose);
}

void Hdf5Writer::add_attribute(const std::string& object, const std::string& attribute,
                               const std::string& text) {
  const std::string what = "write the attribute " + attribute + " of " + object;
  const Hdf5Id type = text_type(), space(H5Screate(H5S_SCALAR), H5Sclose);
  const Hdf5Id id(check(H5Acreate_by_name(file_, object.c_str(), attribute.c_str(), type, space,
                                          H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT),
                        what),
                  H5Aclose);
  const char* value = text.c_str();
  check(H5Awrite(id, type, &value), what);
}

Hdf5Id Hdf5Writer::make_dataset(const std::string& name, std::int64_t type, const Hdf5Shape& shape,
                                Hdf5Storage storage) {
  const Hdf5Id creation(H5Pcreate(H5P_DATASET_CREATE), H5Pclose);
  H5Pset_obj_track_times(creation, false);
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
  }
  const Hdf5Id space = space_of(shape);
  return Hdf5Id(
      check(H5Dcreate2(file_, name.c_str(), type, space, H5P_DEFAULT, creation, H5P_DEFAULT),
            "make " + name),
      H5Dclose);
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

Hdf5Id Hdf5Writer::add_slices(const std::string& name, const Hdf5Shape& shape) {
  return make_dataset(name, H5T_IEEE_F64LE, shape, storage_);
}

void Hdf5Writer::write_slice(const Hdf5Id& dataset, size_t index, std::span<const double> values) {
  const Hdf5Id space(H5Dget_space(dataset), H5Sclose);
  const Hdf5Shape slice = select_slice(space, index);
  if (slice.empty() || product(slice) != values.size()) fail("HDF5 cannot select a slice");
  const Hdf5Id memory = space_of(slice);
  check(H5Dwrite(dataset, H5T_NATIVE_DOUBLE, memory, space, H5P_DEFAULT, values.data()),
        "write a slice");
}

void Hdf5Writer::commit() {
  // Closing makes HDF5 write its last metadata into the image.
  check(file_.close(), "finish the file in memory");
  const size_t length = file_length(image_.bytes);
  if (length == 0) check(-1, "give the bytes of the file in memory");
  write_whole_file(path_, {reinterpret_cast<const char*>(image_.bytes), length});
}

Hdf5Writer::Image::~Image() { std::free(bytes); }

}  // namespace ballast
