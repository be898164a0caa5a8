#include "solvers/backends/newton.hpp"

#include "problems/algebra/known_solutions.hpp"
#include "solvers/seam/run_solver.hpp"
#include "tests/catch.hpp"

using namespace ballast;

TEST_CASE("the proximal Newton solves rank-deficient problems of unequal masses, nearly all",
          "[factors]") {
  int solved = 0;
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    const KnownSolution known = make_known_solution({.bodies = 20,
                                                     .contacts = 120,  // 360 rows on 120 unknowns
                                                     .mass_ratio = seed % 2 ? 1.0 : 100.0,
                                                     .seed = seed});
    const auto solver = make_proximal_newton();
    const SolverRun run =
        SolverRunner().run(*solver, known.problem, {},
                           {.tolerance = 1e-8, .max_iterations = 400, .max_seconds = 20.0});
    CAPTURE(seed, run.solved.iterations, run.error.natural_map_rms);
    CHECK(run.error.natural_map_rms < 1e-4);
    CHECK(run.is_solved() == (run.solved.reason == StopReason::reached_tolerance));
    solved += run.is_solved();
  }
  CHECK(solved >= 19);  // seed 6 stays at 2e-5
}

TEST_CASE("the proximal Newton sweeps a warm start as well, and never loses it", "[factors]") {
  const KnownSolution known = make_known_solution({.bodies = 60, .contacts = 90});
  const Budget budget{.tolerance = 1e-6, .max_iterations = 50};
  for (const bool accelerated : {false, true}) {
    const auto solver = make_proximal_newton({.start_sweeps = 2000, .accelerated = accelerated});
    // Sweeps are enough, and they are not counted.
    const SolverRun run = SolverRunner().run(*solver, known.problem, 0.5 * known.r, budget);
    CHECK(run.is_solved());
    CHECK(run.solved.iterations == 0);
    const SolverRun there = SolverRunner().run(*solver, known.problem, known.r, budget);
    CHECK(there.is_solved());
    CHECK(there.solved.impulses == known.r);
  }
}
