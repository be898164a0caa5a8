// A plan in TOML.

#include "experiments/plans/plan.hpp"
#include "experiments/run/run.hpp"
#include "tests/fuzz/fuzz_file.hpp"

/// As in the program, without the check of the solver's name, which would link all solvers.
ballast::ResolvedScene ballast::resolve_run(const std::string& scene,
                                            const std::vector<std::string>& overrides) {
  return resolve_scene(find_scene(scene), overrides);
}

using namespace ballast;

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const auto file = fuzz::input_folder().write("plan.toml", fuzz::text_of(data, size));
  fuzz::refused_or(file, [&] { read_plan(file); });
  return 0;
}
