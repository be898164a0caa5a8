// The inner loops by name.

#include "experiments/bench/kernels.hpp"

#include <set>

#include "solvers/parts/sparse_factor.hpp"
#include "solvers/solver_list.hpp"
#include "tests/catch.hpp"
#include "tests/experiments/bench/tiny_box.hpp"

using namespace ballast;

TEST_CASE("Kernels run by name, or the library is named that is missing") {
  const KernelProblem problem = kernel_problem(tiny_box(), 2);
  KernelBenchOptions options;
  options.min_time = 1e-4;
  options.repeats = 3;
  options.streaming_MB = 0.1;
  try {
    options.filter = "one contact|problem/judge";
    const auto measured = run_kernels(problem, options, MachineFacts{});
    CHECK(value_of(measured, "one contact/stick") > 0.0);
    CHECK(value_of(measured, "problem/judge") > 0.0);
    CHECK(value_of(measured, "floor/sweep bytes streamed") > 0.0);
    for (const Measurement& m : measured)
      CHECK_THAT(m.full_name(), Catch::StartsWith("one contact/") || Catch::StartsWith("floor/") ||
                                    Catch::Equals("problem/judge"));
    options.filter = "no such kernel";
    CHECK_THROWS_WITH(run_kernels(problem, options, MachineFacts{}),
                      Catch::Contains("no such kernel"));
  } catch (const MissingSolver& missing) {
    CHECK_THAT(missing.what(), Catch::Contains("Google Benchmark"));
  }
}

TEST_CASE("Every kernel does what it is timed for, again and again") {
  const KernelProblem problem = kernel_problem(tiny_box(), 2);
  std::vector<Kernel> kernels;
  add_detection_kernels(kernels);
  add_problem_kernels(problem, kernels);
  add_sweep_kernels(problem, 2, kernels);
  add_one_contact_kernels(kernels);
  const size_t before = kernels.size();
  add_factor_kernels(problem, kernels);
  CHECK((kernels.size() > before) == has_sparse_factors());
  std::set<std::string> names;
  for (const Kernel& kernel : kernels) {
    INFO(kernel.group << "/" << kernel.name);
    CHECK(names.insert(kernel.group + "/" + kernel.name).second);
    CHECK(kernel.items >= 1.0);
    CHECK_NOTHROW(kernel.call());
    CHECK_NOTHROW(kernel.call());
  }
}
