#pragma once
// A wide sweep from zero impulses, in single precision or not.

#include "platform/worker_team.hpp"
#include "solvers/gauss_seidel/wide_sweep.hpp"
#include "tests/catch.hpp"

namespace ballast::samples {

struct SingleSweep {
  SweepPlan plan;
  WorkerTeam team;
  WideSweep wide{plan};

  SingleSweep(const FrictionProblem& problem, bool single,
              const GroupKernels& kernels = group_kernels(), int threads = 1) {
    team.resize(threads);
    wide.use_team(&team);
    plan.prepare(problem);
    wide.use_kernels(kernels);
    REQUIRE(wide.prepare(problem));
    wide.allow_single(single);
    wide.load(problem, Impulses::Zero(problem.row_count()));
  }
};

}  // namespace ballast::samples
