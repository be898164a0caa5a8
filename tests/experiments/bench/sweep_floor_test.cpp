// The roofline of a sweep, from the layout of its records.

#include "experiments/bench/sweep_floor.hpp"

#include "experiments/bench/kernel_problem.hpp"
#include "solvers/gauss_seidel/group_kernels.hpp"
#include "tests/catch.hpp"
#include "tests/experiments/bench/tiny_box.hpp"

using namespace ballast;

TEST_CASE("The floor counts the records that the sweep reads") {
  CHECK(friction_cost().streamed_bytes() * group_lanes ==
        sizeof(FrictionGroup<double>) + 2 * sizeof(GroupImpulses<double, 3>));
  // velocities: 3 + 3 rows x 18; changes of two bodies: 15 + 12 + 36; 16 of its own
  CHECK(friction_cost().flops == 57 + 63 + 16);
  CHECK(one_row_cost().flops < friction_cost().flops / 2);
  const FrictionProblem problem = kernel_problem(tiny_box(), 1).problem;
  const SweepCost mean = mean_sweep_cost(problem);
  CHECK(mean.streamed_bytes() <= Approx(friction_cost().streamed_bytes()));
  CHECK(mean.streamed_bytes() >= one_row_cost().streamed_bytes());
  CHECK(mean_sweep_cost(FrictionProblem{}).streamed_bytes() == 0.0);
  CHECK(sweep_working_set(repeated(problem, 3)) == Approx(3.0 * sweep_working_set(problem)));
}

TEST_CASE("The floor is what lasts longer: bytes or flops") {
  const FrictionProblem problem = kernel_problem(tiny_box(), 1).problem;
  const SweepCost cost = mean_sweep_cost(problem);
  MachineFacts facts;
  facts.read_GB_s = 2.0;
  facts.gflops = 1e9;  // flops for nothing
  const auto by_bytes = floor_measurements(problem, facts);
  CHECK(value_of(by_bytes, "floor/sweep floor streaming") == Approx(cost.streamed_bytes() / 2.0));
  facts.gflops = 1e-3;
  const auto by_flops = floor_measurements(problem, facts);
  CHECK(value_of(by_flops, "floor/sweep floor streaming") == Approx(1e3 * cost.flops));
  CHECK(value_of(by_flops, "floor/sweep floor in cache") == Approx(1e3 * cost.flops));
}
