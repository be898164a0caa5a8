// The recommended backend: sweeps alone where they are enough, Newton where they stall, and the
// same turns whatever the machine does meanwhile.

#include "solvers/backends/auto.hpp"

#include "problems/algebra/pile_problems.hpp"
#include "solvers/backends/gauss_seidel.hpp"
#include "solvers/seam/run_solver.hpp"
#include "solvers/solver_list.hpp"
#include "tests/catch.hpp"

using namespace ballast;

namespace {

SolverRun solved(Solver& solver, const FrictionProblem& problem, double seconds = 20.0) {
  const Budget budget{
      .tolerance = 1e-9, .max_iterations = 1 << 28, .max_seconds = seconds, .keep_history = true};
  return SolverRunner().run(solver, problem, {}, budget);
}

/// A stored pile on which sweeps crawl: redundant, slender, light below heavy.
FrictionProblem hard_pile() {
  PileSettings settings;
  settings.contacts = 60;
  settings.redundancy = 0.6;
  settings.mass_ratio = 1e3;
  settings.slenderness = 8.0;
  settings.shear = 0.1;
  settings.is_stored = true;
  return make_pile(settings);
}

}  // namespace

TEST_CASE("auto leaves sweeps that stall", "[factors]") {
  const FrictionProblem problem = hard_pile();
  const auto automatic = make_auto(), sweeps = make_gauss_seidel();
  const SolverRun with = solved(*automatic, problem), without = solved(*sweeps, problem);
  CHECK(with.success);
  CHECK(5 * with.solved.iterations < without.solved.iterations);
}

TEST_CASE("auto sweeps alone where that is enough", "[factors]") {
  PileSettings settings;
  settings.contacts = 40;
  settings.redundancy = 0.0;
  settings.shear = 2.0;
  settings.is_stored = true;
  const FrictionProblem problem = make_pile(settings);
  const auto automatic = make_auto(), sweeps = make_solver("anderson_pgs");
  const SolverRun run = solved(*automatic, problem), alone = solved(*sweeps, problem);
  CHECK(run.success);
  CHECK(run.solved.iterations == alone.solved.iterations);
  CHECK(run.solved.impulses == alone.solved.impulses);
}

TEST_CASE("auto takes the same turns every time", "[factors]") {
  const FrictionProblem problem = hard_pile();
  const auto automatic = make_auto();
  const SolverRun first = solved(*automatic, problem), again = solved(*automatic, problem);
  CHECK(first.solved.iterations == again.solved.iterations);
  CHECK(first.solved.impulses == again.solved.impulses);
}

TEST_CASE("auto solves every pile that another backend solves", "[factors]") {
  for (std::uint64_t seed = 101; seed <= 112; ++seed) {
    const FrictionProblem problem = make_pile(random_pile(seed, 60));
    INFO("pile of seed " << seed << ", " << problem.contact_count() << " contacts");
    const auto automatic = make_auto();
    CHECK(solved(*automatic, problem).success);
  }
}
