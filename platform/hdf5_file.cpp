#include "platform/hdf5_file.hpp"

#include <hdf5.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <functional>
#include <limits>
#include <numeric>
#include <type_traits>

#include "platform/atomic_file.hpp"
#include "platform/error.hpp"

namespace ballast {

/// The disk as HDF5 sees it while it makes a file: one that never fills up. HDF5 cannot recover
/// from a failed write: a dataset that is closed by its destructor would lose a chunk silently,
/// handles would stay open, and the end of the program would try again. So every write reports
/// success; the first failure is kept, and Hdf5Writer::check() throws it.
struct Hdf5Disk {
  AtomicFile file;
  int descriptor = file.descriptor();
  int error = 0;  // errno of the first failure, after which nothing is written any more
};

namespace {

/// The number of entries.
unsigned long long product(const Hdf5Shape& shape) {
  return std::accumulate(shape.begin(), shape.end(), hsize_t{1}, std::multiplies<>());
}

/// The HDF5 type of UTF-8 texts of any length.
Hdf5Id text_type() {
  Hdf5Id type(H5Tcopy(H5T_C_S1), H5Tclose);
  H5Tset_size(type, H5T_VARIABLE);
  H5Tset_cset(type, H5T_CSET_UTF8);
  return type;
}

/// The HDF5 dataspace of an array of that shape.
Hdf5Id space_of(const Hdf5Shape& shape) {
  return {H5Screate_simple(static_cast<int>(shape.size()), shape.data(), nullptr), H5Sclose};
}

/// Selects `entries` entries of `space` as whole rows along its first dimension, from row `first`
/// on, and returns their shape. Throws Error "<file>: HDF5 cannot <action>" when there are no such
/// rows.
Hdf5Shape select_rows(const Hdf5File& file, const Hdf5Id& space, size_t first, size_t entries,
                      const std::string& action) {
  Hdf5Shape count(static_cast<size_t>(std::max(H5Sget_simple_extent_ndims(space), 0)));
  H5Sget_simple_extent_dims(space, count.data(), nullptr);
  if (count.empty()) file.fail("HDF5 cannot " + action);
  // The selection is some rows along the first dimension and all of the others.
  Hdf5Shape start(count.size(), 0);
  const unsigned long long rows = count[0], row = product({count.begin() + 1, count.end()});
  start[0] = first;
  count[0] = row > 0 ? entries / row : 0;
  if (count[0] == 0 || entries % row != 0 || first >= rows || count[0] > rows - first ||
      H5Sselect_hyperslab(space, H5S_SELECT_SET, start.data(), nullptr, count.data(), nullptr) < 0)
    file.fail("HDF5 cannot " + action);
  return count;
}

hid_t open_for_reading(const Hdf5File& file, const std::filesystem::path& path) {
  if (access(path.c_str(), R_OK) != 0 && errno != ENOENT && errno != ENOTDIR)
    throw_file_error(path, "open");
  if (!is_file(path)) file.fail(path_exists(path) ? "not a regular file" : "no such file");
  // The signature is checked first: a text file and a truncated HDF5 file get different messages.
  if (H5Fis_hdf5(path.c_str()) <= 0) file.fail("not an HDF5 file");
  const hid_t id = H5Fopen(path.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT);
  if (id < 0) file.fail("damaged or truncated HDF5 file");
  return id;
}

/// A file that HDF5 has open. `given`: the end of the addresses that HDF5 has allocated; `length`:
/// the end of the bytes that were written.
struct OpenFile : H5FD_t {
  std::shared_ptr<Hdf5Disk> disk;
  haddr_t given = 0, length = 0;
};
OpenFile& of(H5FD_t* file) { return *static_cast<OpenFile*>(file); }
const OpenFile& of(const H5FD_t* file) { return *static_cast<const OpenFile*>(file); }

herr_t write_file(H5FD_t* file, H5FD_mem_t, hid_t, haddr_t offset, size_t size,
                  const void* buffer) {
  of(file).length = std::max<haddr_t>(of(file).length, offset + size);
  Hdf5Disk& disk = *of(file).disk;
  for (size_t done = 0; done < size && disk.error == 0;) {
    const ssize_t count = pwrite(disk.descriptor, static_cast<const char*>(buffer) + done,
                                 size - done, static_cast<off_t>(offset + done));
    if (count < 0)
      disk.error = errno;
    else
      done += static_cast<size_t>(count);
  }
  return 0;
}

/// Reads the bytes there; zeros beyond the end and where nothing was written.
herr_t read_file(H5FD_t* file, H5FD_mem_t, hid_t, haddr_t offset, size_t size, void* buffer) {
  std::memset(buffer, 0, size);
  Hdf5Disk& disk = *of(file).disk;
  if (disk.error == 0 && pread(disk.descriptor, buffer, size, static_cast<off_t>(offset)) < 0)
    disk.error = errno;
  return 0;
}

/// Makes the file end at the last allocated address.
herr_t end_file(H5FD_t* file, hid_t, hbool_t) {
  OpenFile& open = of(file);
  if (open.disk->error == 0 && open.length != open.given &&
      ftruncate(open.disk->descriptor, static_cast<off_t>(open.given)) != 0)
    open.disk->error = errno;
  open.length = open.given;
  return 0;
}

hid_t register_driver() {
  H5FD_class_t driver{};
  driver.name = "ballast";
  driver.maxaddr = std::numeric_limits<std::int64_t>::max();
  driver.fc_degree = H5F_CLOSE_WEAK;
  driver.fapl_size = sizeof(const std::shared_ptr<Hdf5Disk>*);
  driver.open = [](const char*, unsigned, hid_t access, haddr_t) -> H5FD_t* {
    auto* file = new OpenFile();
    file->disk = **static_cast<const std::shared_ptr<Hdf5Disk>* const*>(H5Pget_driver_info(access));
    return file;
  };
  driver.close = [](H5FD_t* file) -> herr_t {
    delete &of(file);
    return 0;
  };
  // HDF5 allocates space in the way of its own drivers for single files.
  driver.query = [](const H5FD_t*, unsigned long* features) -> herr_t {
    *features = H5FD_FEAT_AGGREGATE_METADATA | H5FD_FEAT_ACCUMULATE_METADATA |
                H5FD_FEAT_DATA_SIEVE | H5FD_FEAT_AGGREGATE_SMALLDATA;
    return 0;
  };
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

/// A property list for objects to be created, which stores no time of day.
Hdf5Id timeless(hid_t kind) {
  Hdf5Id properties(H5Pcreate(kind), H5Pclose);
  H5Pset_obj_track_times(properties, false);
  return properties;
}

/// Makes an HDF5 file whose bytes go to `disk`. Returns its handle, negative when HDF5 fails.
hid_t create_file(const std::shared_ptr<Hdf5Disk>& disk) {
  static const hid_t driver = register_driver();
  const Hdf5Id access(H5Pcreate(H5P_FILE_ACCESS), H5Pclose), creation = timeless(H5P_FILE_CREATE);
  const std::shared_ptr<Hdf5Disk>* order = &disk;
  H5Pset_driver(access, driver, &order);
  H5Pset_libver_bounds(access, H5F_LIBVER_V18, H5F_LIBVER_LATEST);
  return H5Fcreate("on our disk", H5F_ACC_TRUNC, creation, access);
}

constexpr hsize_t chunk_bytes = 1 << 16;  // one chunk; datasets up to 1/16 of it stay plain
constexpr unsigned deflate_level = 4;

hid_t type_of(Hdf5Number number) {
  return number == Hdf5Number::float64 ? H5T_NATIVE_DOUBLE
         : number == Hdf5Number::int32 ? H5T_NATIVE_INT32
         : number == Hdf5Number::int64 ? H5T_NATIVE_INT64
                                       : H5T_NATIVE_UINT64;
}

}  // namespace

// The header has these types in place of HDF5's own.
static_assert(std::is_same_v<hid_t, std::int64_t> && std::is_same_v<herr_t, int> &&
              std::is_same_v<hsize_t, Hdf5Shape::value_type>);

Hdf5File::Hdf5File(const std::filesystem::path& path) : path_(path) {
  // HDF5 would print its error stack to stderr; Error reports failures instead.
  H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);
}

void Hdf5File::fail(const std::string& what) const { throw Error(path_.string() + ": " + what); }

std::int64_t Hdf5File::check(std::int64_t result, const std::string& action) const {
  if (result < 0) fail("HDF5 cannot " + action);
  return result;
}

// ---- reading

Hdf5Reader::Hdf5Reader(const std::filesystem::path& file)
    : Hdf5File(file), file_(open_for_reading(*this, file), H5Fclose) {}

/// Checks group after group, because HDF5 fails on a path whose parent is missing.
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

/// Checks the size before memory is allocated: a damaged header can claim any number of entries.
/// Stored bytes are part of the file, and HDF5's compressions shrink data 1032 times at most.
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
std::vector<Value> Hdf5Reader::read(const std::string& name,
                                    std::optional<std::size_t> expected) const {
  // The stored type may have any width or byte order: HDF5 converts it while reading.
  const hid_t type = std::is_same_v<Value, double> ? H5T_NATIVE_DOUBLE
                     : std::is_same_v<Value, int>  ? H5T_NATIVE_INT
                                                   : H5T_NATIVE_UINT64;
  const Hdf5Id dataset = open(name), space(H5Dget_space(dataset), H5Sclose),
               stored(H5Dget_type(dataset), H5Tclose);
  const H5T_class_t kind = stored >= 0 ? H5Tget_class(stored) : H5T_NO_CLASS;
  if (kind != H5T_INTEGER && kind != H5T_FLOAT) fail(name + ": does not hold numbers");
  const hssize_t size = space >= 0 ? H5Sget_simple_extent_npoints(space) : -1;
  if (size < 0) fail(name + ": has no readable extent");
  if (expected && static_cast<std::size_t>(size) != *expected)
    fail(name + " has " + std::to_string(size) + " entries, must have " +
         std::to_string(*expected));
  require_stored(name, dataset, static_cast<unsigned long long>(size));
  std::vector<Value> values(static_cast<size_t>(size));
  if (size > 0 && H5Dread(dataset, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data()) < 0)
    fail(name + ": cannot be read (damaged or truncated)");
  return values;
}

template std::vector<double> Hdf5Reader::read(const std::string&, std::optional<size_t>) const;
template std::vector<int> Hdf5Reader::read(const std::string&, std::optional<size_t>) const;
template std::vector<std::uint64_t> Hdf5Reader::read(const std::string&,
                                                     std::optional<size_t>) const;

int Hdf5Reader::read_int(const std::string& name) const { return read<int>(name, 1)[0]; }

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
  const Hdf5Shape rows = select_rows(*this, space, first, count * product(of_row), what);
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
  // HDF5 allocated each text: it is copied and given back. A text never written is null.
  std::vector<std::string> texts;
  for (const char* text : pointers) texts.emplace_back(text ? text : "");
  H5Dvlen_reclaim(type, space, H5P_DEFAULT, pointers.data());
  return texts;
}

// ---- writing

Hdf5Writer::Hdf5Writer(const std::filesystem::path& target, Hdf5Storage storage)
    : Hdf5File(target),
      storage_(storage),
      disk_(new Hdf5Disk{.file = AtomicFile(target)}),
      file_(create_file(disk_), H5Fclose) {
  check(file_, "make a file");
}

std::int64_t Hdf5Writer::check(std::int64_t result, const std::string& action) const {
  errno = disk_->error;
  if (errno != 0) throw_file_error(path_, "write");
  return Hdf5File::check(result, action);
}

void Hdf5Writer::add_group(const std::string& name) {
  const Hdf5Id creation = timeless(H5P_GROUP_CREATE),
               group(H5Gcreate2(file_, name.c_str(), H5P_DEFAULT, creation, H5P_DEFAULT), H5Gclose);
  check(group, "make " + name);
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
  const Hdf5Id creation = timeless(H5P_DATASET_CREATE),
               access(H5Pcreate(H5P_DATASET_ACCESS), H5Pclose);
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
    // So much of a dataset that is filled step by step is cached until a chunk is whole.
    H5Pset_chunk_cache(access, H5D_CHUNK_CACHE_NSLOTS_DEFAULT, 4 * chunk_bytes,
                       H5D_CHUNK_CACHE_W0_DEFAULT);
  }
  const Hdf5Id space = space_of(shape);
  Hdf5Id dataset(H5Dcreate2(file_, name.c_str(), type, space, H5P_DEFAULT, creation, access),
                 H5Dclose);
  check(dataset, "make " + name);
  return dataset;
}

void Hdf5Writer::add(const std::string& name, Hdf5Number number, const void* values,
                     const Hdf5Shape& shape) {
  const Hdf5Id dataset = make_dataset(name, type_of(number), shape, storage_);
  if (product(shape) > 0)
    check(H5Dwrite(dataset, type_of(number), H5S_ALL, H5S_ALL, H5P_DEFAULT, values),
          "write " + name);
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
  return make_dataset(name, type_of(number), shape, storage_);
}

void Hdf5Writer::write_rows(const Hdf5Id& dataset, size_t first, std::span<const double> values) {
  const Hdf5Id space(H5Dget_space(dataset), H5Sclose);
  const Hdf5Shape rows = select_rows(*this, space, first, values.size(), "select rows");
  const Hdf5Id memory = space_of(rows);
  check(H5Dwrite(dataset, H5T_NATIVE_DOUBLE, memory, space, H5P_DEFAULT, values.data()),
        "write rows");
}

void Hdf5Writer::commit() {
  // Closing makes HDF5 write its last metadata.
  check(file_.close(), "finish the file");
  disk_->file.commit();
}

}  // namespace ballast
