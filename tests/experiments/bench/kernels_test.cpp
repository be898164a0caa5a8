// The inner loops by name.

#include "experiments/bench/kernels.hpp"

#include <set>

#include "tests/experiments/bench/tiny_box.hpp"

using namespace ballast;

TEST_CASE("Every kernel does what it is timed for, again and again, and is found by its name") {
  const std::vector<Kernel> kernels = step_kernels(tiny_box(), 2);
  std::set<std::string> names;
  for (const Kernel& kernel : kernels) {
    INFO(kernel.group << "/" << kernel.name);
    CHECK(names.insert(kernel.group + "/" + kernel.name).second);
    CHECK(kernel.items > 1.0);
  }
  CHECK(names.contains("detection/from scratch"));
  KernelBenchOptions options;
  options.min_time = 1e-4;
  options.repeats = 3;
  const auto all = run_kernels(kernels, options);
  REQUIRE(all.size() == kernels.size());
  for (const Measurement& m : all) {
    INFO(m.full_name());
    CHECK(m.low > 0.0);
    CHECK(m.samples == 3);
  }
  options.filter = "em/jud";
  CHECK(run_kernels(kernels, options).at(0).name == "judge");
  options.filter = "no such kernel";
  CHECK_THROWS_WITH(run_kernels(kernels, options), Catch::Contains("no such kernel"));
}
