#include "platform/hdf5_file.hpp"

#include <hdf5.h>

#include <algorithm>
#include <functional>
#include <numeric>
#include <type_traits>

#include "platform/error.hpp"

namespace ballast {

// What the header says in place of HDF5's own types.
static_assert(std::is_same_v<hid_t, std::int64_t> && std::is_same_v<herr_t, int> &&
              std::is_same_v<hsize_t, Hdf5Shape::value_type>);

Hdf5File::Hdf5File(const std::filesystem::path& path) : path_(path) {
  // HDF5 would print its error stack to stderr; what went wrong is said by an Error instead.
  H5Eget_auto2(H5E_DEFAULT, &old_report_, &old_client_);
  H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);
}

Hdf5File::~Hdf5File() { H5Eset_auto2(H5E_DEFAULT, old_report_, old_client_); }

void Hdf5File::fail(const std::string& what) const { throw Error(path_.string() + ": " + what); }

std::int64_t Hdf5File::check(std::int64_t result, const std::string& action) const {
  if (result < 0) fail("HDF5 cannot " + action);
  return result;
}

Hdf5Id Hdf5File::text_type() {
  Hdf5Id type(H5Tcopy(H5T_C_S1), H5Tclose);
  H5Tset_size(type, H5T_VARIABLE);
  H5Tset_cset(type, H5T_CSET_UTF8);
  return type;
}

Hdf5Id Hdf5File::space_of(const Hdf5Shape& shape) {
  return {H5Screate_simple(static_cast<int>(shape.size()), shape.data(), nullptr), H5Sclose};
}

Hdf5Shape Hdf5File::select_rows(const Hdf5Id& space, size_t first, size_t entries) {
  Hdf5Shape count(static_cast<size_t>(std::max(H5Sget_simple_extent_ndims(space), 0)));
  H5Sget_simple_extent_dims(space, count.data(), nullptr);
  if (count.empty()) return {};
  // Some rows along the first dimension, all of the others.
  Hdf5Shape start(count.size(), 0);
  const unsigned long long rows = count[0], row = product({count.begin() + 1, count.end()});
  start[0] = first;
  count[0] = row > 0 ? entries / row : 0;
  if (count[0] == 0 || entries % row != 0 || first >= rows || count[0] > rows - first) return {};
  const herr_t selected =
      H5Sselect_hyperslab(space, H5S_SELECT_SET, start.data(), nullptr, count.data(), nullptr);
  return selected < 0 ? Hdf5Shape{} : count;
}

unsigned long long Hdf5File::product(const Hdf5Shape& shape) {
  return std::accumulate(shape.begin(), shape.end(), hsize_t{1}, std::multiplies<>());
}

}  // namespace ballast
