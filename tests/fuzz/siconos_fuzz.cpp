// A problem in Siconos' text format.

#include "problems/files/siconos_text.hpp"
#include "tests/fuzz/fuzz_file.hpp"

using namespace ballast;

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const auto file = fuzz::input_folder().write("problem.dat", fuzz::text_of(data, size));
  fuzz::refused_or(file, [&] {
    auto stored = read_siconos_text(file);
    const FrictionProblem problem =
        std::visit([](auto& form) { return to_friction_problem(std::move(form)); }, stored);
    problem.validate();
  });
  return 0;
}
