#pragma once
// HDF5 files from a text, so that the fuzzer varies the content that our readers see and not the
// library's own bytes (where HDF5 1.10 has bugs of its own, which we cannot mend).
//
//   /fclib_local/W/x f8 2,3 1 -0.5 1e300     a dataset: path, type, shape, values; missing ones are
//                                            0, and of a dataset above 4096 entries none is written
//   /fclib_local group                       an empty group
//   /bodies/name text 2 floor lid            texts of any length; "letters": of eight bytes
//
// Types: i1 i2 i4 i8 u4 u8 f4 f8, and those with b in front (big-endian), text, letters. Missing
// groups of a path are made. Lines that HDF5 or this reader does not take are skipped.

#include <filesystem>
#include <string_view>

namespace ballast::fuzz {

void write_described_hdf5(std::string_view description, const std::filesystem::path& file);

}  // namespace ballast::fuzz
