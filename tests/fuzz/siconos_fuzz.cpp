// A problem in Siconos' text format.

#include "problems/files/problem_file.hpp"
#include "tests/fuzz/fuzz_file.hpp"

using namespace ballast;

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const auto file = fuzz::input_folder().write("problem.dat", fuzz::text_of(data, size));
  fuzz::refused_or(file, [&] { read_problem(file); });
  return 0;
}
