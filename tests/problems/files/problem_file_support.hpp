#pragma once
// Common to the tests of stored problems: a folder, a small problem, files damaged on purpose.

#include <hdf5.h>

#include <filesystem>
#include <fstream>
#include <limits>

#include "problems/algebra/known_solutions.hpp"
#include "problems/files/problem_file.hpp"
#include "tests/catch.hpp"
#include "tests/support/complaint.hpp"
#include "tests/support/delassus_form.hpp"
#include "tests/support/temporary_folder.hpp"

namespace ballast {

namespace fs = std::filesystem;

/// A folder of its own, which is removed with the test.
struct Folder : TemporaryFolder {
  fs::path operator/(const std::string& name) const { return path() / name; }
};

inline KnownSolution small(double frictionless = 0.0) {
  return make_known_solution(
      {.bodies = 4, .contacts = 6, .friction_min = 0.1, .frictionless_fraction = frictionless});
}

/// The complaint of the reader about the file, in one line, after the file's name.
template <typename Read>
std::string complaint(const fs::path& file, const Read& read) {
  return complaint_about(file, [&] { read(file); });
}
inline std::string complaint(const fs::path& file) { return complaint(file, read_problem); }

inline void write_text(const fs::path& file, const std::string& text) {
  std::ofstream(file, std::ios::binary) << text;
}

inline void remove(const fs::path& file, const char* path) {
  const hid_t id = H5Fopen(file.c_str(), H5F_ACC_RDWR, H5P_DEFAULT);
  REQUIRE(H5Ldelete(id, path, H5P_DEFAULT) >= 0);
  H5Fclose(id);
}

/// Replaces the numbers of the dataset.
template <typename Value>
void replace(const fs::path& file, const char* path, const std::vector<Value>& values) {
  remove(file, path);
  const hid_t id = H5Fopen(file.c_str(), H5F_ACC_RDWR, H5P_DEFAULT);
  const hid_t type = std::is_same_v<Value, int> ? H5T_NATIVE_INT : H5T_NATIVE_DOUBLE;
  const hsize_t size = values.size();
  const hid_t space = H5Screate_simple(1, &size, nullptr);
  const hid_t data = H5Dcreate2(id, path, type, space, H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT);
  REQUIRE(H5Dwrite(data, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data()) >= 0);
  H5Dclose(data);
  H5Sclose(space);
  H5Fclose(id);
}

/// Replaces the dataset by one that claims `entries` numbers and stores none, in a few bytes.
inline void claim(const fs::path& file, const char* path, hsize_t entries) {
  remove(file, path);
  const hid_t id = H5Fopen(file.c_str(), H5F_ACC_RDWR, H5P_DEFAULT);
  const hid_t space = H5Screate_simple(1, &entries, nullptr), how = H5Pcreate(H5P_DATASET_CREATE);
  const hsize_t chunk = 1000;
  H5Pset_chunk(how, 1, &chunk);
  const hid_t data = H5Dcreate2(id, path, H5T_NATIVE_DOUBLE, space, H5P_DEFAULT, how, H5P_DEFAULT);
  REQUIRE(data >= 0);
  H5Dclose(data);
  H5Pclose(how);
  H5Sclose(space);
  H5Fclose(id);
}

inline const double not_a_number = std::numeric_limits<double>::quiet_NaN();

}  // namespace ballast
