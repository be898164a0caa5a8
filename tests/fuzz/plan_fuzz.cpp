// A plan in TOML.

#include "experiments/plans/plan.hpp"
#include "tests/fuzz/fuzz_file.hpp"

using namespace ballast;

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const auto file = fuzz::input_folder().write("plan.toml", fuzz::text_of(data, size));
  fuzz::refused_or(file, [&] { read_plan(file); });
  return 0;
}
