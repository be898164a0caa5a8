#pragma once
// Reads an attribute of an HDF5 file by HDF5 alone, as the program only writes attributes.

#include <hdf5.h>

#include <filesystem>
#include <string>

#include "tests/catch.hpp"

namespace ballast {

/// An attribute that is a text of any length. `object`: a group or a dataset, "/" for the file.
inline std::string hdf5_attribute(const std::filesystem::path& path, const std::string& object,
                                  const std::string& name) {
  const hid_t file = H5Fopen(path.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT);
  const hid_t attribute =
      H5Aopen_by_name(file, object.c_str(), name.c_str(), H5P_DEFAULT, H5P_DEFAULT);
  const hid_t type = H5Aget_type(attribute);
  char* value = nullptr;
  REQUIRE(H5Tis_variable_str(type) > 0);
  REQUIRE(H5Aread(attribute, type, &value) >= 0);
  const std::string text = value ? value : "";
  H5free_memory(value);
  H5Tclose(type);
  H5Aclose(attribute);
  H5Fclose(file);
  return text;
}

}  // namespace ballast
