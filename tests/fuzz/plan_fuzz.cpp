// A plan in TOML. What is taken comes back when it is written and read.

#include "experiments/plans/plan.hpp"
#include "tests/fuzz/fuzz_file.hpp"

using namespace ballast;

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const auto file = fuzz::input_folder().write("plan.toml", fuzz::text_of(data, size));
  fuzz::refused_or(file, [&] {
    const Plan plan = read_plan(file);
    const auto copy = fuzz::input_folder().path() / "copy.toml";
    write_plan(plan, copy);
    const Plan again = read_plan(copy);
    if (again.runs.size() != plan.runs.size()) fuzz::finding("written with other runs");
    for (std::size_t k = 0; k < plan.runs.size(); ++k)
      if (again.runs[k].name != plan.runs[k].name ||
          again.runs[k].overrides != plan.runs[k].overrides)
        fuzz::finding("run " + plan.runs[k].name + " is written as another");
  });
  return 0;
}
