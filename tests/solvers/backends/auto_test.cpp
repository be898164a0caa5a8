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

TEST_CASE("where a Newton step costs few sweeps, its turn comes before a hundred of them",
          "[factors]") {
  // Sweeps with Newton steps between them, over the bodies: the other ways took 200 to 370.
  const Budget budget{.tolerance = 1e-8 * 0.05, .max_iterations = 1 << 30};
  PileSettings settings{.contacts = 60,
                        .redundancy = 0.4,
                        .mass_ratio = 30.0,
                        .friction_min = 0.1,
                        .friction_max = 0.9};
  for (const std::uint64_t seed : {13u, 15u}) {
    settings.seed = seed;
    const SolverRun run = solved(make_auto(), make_pile(settings), budget);
    CHECK(run.success);
    CHECK(run.solved.iterations < 120);
  }
}
