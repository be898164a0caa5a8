#pragma once
// HDF5 files out of a text, so that a fuzzer plays with what our readers see of a file and not with
// the library's own bytes (HDF5 1.10 has bugs of its own there, which are not ours to mend).
//
//   /fclib_local/W/x f8 2,3 1 -0.5 1e300     a dataset: path, type, shape, values; missing ones are
//                                            0, and of a dataset above 4096 entries none is written
//   /fclib_local group                       an empty group
//   /bodies/name text 2 floor lid            texts of any length; "letters": of eight bytes
//
// Types: i1 i2 i4 i8 u4 u8 f4 f8, and those with b in front (big-endian), text, letters. Groups on
// the way are made. A line that HDF5 or this reader does not take is passed over.

#include <filesystem>
#include <string_view>

namespace ballast::fuzz {

void write_described_hdf5(std::string_view description, const std::filesystem::path& file);

}  // namespace ballast::fuzz
