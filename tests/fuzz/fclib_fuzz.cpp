// A problem in FCLIB's HDF5 layout, with and without the additions of a run's capture. The input
// describes the HDF5 file (described_hdf5.hpp).

#include "problems/files/captured_problem.hpp"
#include "problems/files/problem_file.hpp"
#include "tests/fuzz/described_hdf5.hpp"
#include "tests/fuzz/fuzz_file.hpp"

using namespace ballast;

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const auto file = fuzz::input_folder().path() / "problem.hdf5";
  fuzz::write_described_hdf5(fuzz::text_of(data, size), file);
  fuzz::refused_or(file, [&] { read_problem(file).validate(); });
  fuzz::refused_or(file, [&] {
    if (is_captured(file)) read_captured(file).problem.validate();
  });
  return 0;
}
