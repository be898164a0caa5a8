#include "solvers/backends/auto.hpp"

#include "problems/algebra/pile_problems.hpp"
#include "solvers/backends/nncg.hpp"
#include "solvers/seam/run_solver.hpp"
#include "tests/catch.hpp"

using namespace ballast;

namespace {

/// Heavy on light, with more contacts than the bodies' unknowns fix: what sweeps take long for.
FrictionProblem heavy_pile(std::uint64_t seed, bool is_stored) {
  return make_pile({.contacts = 40,
                    .redundancy = 0.5,
                    .mass_ratio = 1e4,
                    .slenderness = 8.0,
                    .is_stored = is_stored,
                    .seed = seed});
}

SolverRun solved(std::unique_ptr<Solver> solver, const FrictionProblem& problem,
                 const Budget& budget) {
  return SolverRunner().run(*solver, problem, {}, budget);
}

}  // namespace

TEST_CASE("where iterations are scarce, sweeps leave them to Newton while there are enough",
          "[factors]") {
  const Budget scarce{.tolerance = 1e-7, .max_iterations = 400};
  int by_sweeps = 0, by_auto = 0;
  for (const bool is_stored : {false, true})
    for (std::uint64_t seed = 1; seed <= 5; ++seed) {
      const FrictionProblem problem = heavy_pile(seed, is_stored);
      const SolverRun run = solved(make_auto(), problem, scarce);
      CHECK(run.solved.iterations <= scarce.max_iterations);
      by_auto += run.success;
      by_sweeps += solved(make_nncg(), problem, scarce).success;
    }
  CHECK(by_auto == 10);
  CHECK(by_sweeps < 5);
}

TEST_CASE("the turns are counted in work, not by the clock: the same bits every time",
          "[factors]") {
  const FrictionProblem problem = heavy_pile(7, true);
  const Budget budget{.tolerance = 1e-9, .max_iterations = 20000};
  const SolverRun first = solved(make_auto(), problem, budget),
                  second = solved(make_auto(), problem, budget);
  CHECK(first.success);
  CHECK(first.solved.iterations == second.solved.iterations);
  CHECK(first.solved.impulses == second.solved.impulses);
}
