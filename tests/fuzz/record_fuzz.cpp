// The steps and poses of record.h5. The input describes the HDF5 file (described_hdf5.hpp). Columns
// that it does not name are added, so that the reader goes through to the end.

#include "experiments/record/record_file.hpp"
#include "tests/fuzz/described_hdf5.hpp"
#include "tests/fuzz/fuzz_file.hpp"

using namespace ballast;

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  std::string description(fuzz::text_of(data, size));
  for (const StepColumn& column : step_columns())
    description += std::string("\n/steps/") + column.name + " f8 3 1 2 3";
  const auto file = fuzz::input_folder().path() / "record.h5";
  fuzz::write_described_hdf5(description, file);
  fuzz::refused_or(file, [&] { read_record_steps(file); });
  fuzz::refused_or(file, [&] { read_record_poses(file); });
  return 0;
}
