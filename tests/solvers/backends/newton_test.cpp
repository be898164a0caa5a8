// The Newton methods on the hardest problems: more rows than the bodies' unknowns, unequal masses.

#include "platform/worker_team.hpp"
#include "problems/algebra/known_solutions.hpp"
#include "solvers/backends/backends.hpp"
#include "tests/catch.hpp"
#include "tests/support/delassus_form.hpp"
#include "tests/support/solved.hpp"

using namespace ballast;

namespace {

FrictionProblem deficient(std::uint64_t seed) {
  return make_known_solution({.bodies = 20,
                              .contacts = 120,  // 360 rows on 120 unknowns
                              .mass_ratio = seed % 2 ? 1.0 : 100.0,
                              .seed = seed})
      .problem;
}

}  // namespace

TEST_CASE("rank-deficient problems of unequal masses are solved, nearly all", "[factors]") {
  struct Method {
    const char* name;
    std::unique_ptr<Solver> (*make)();
    double tolerance, farthest;  ///< [m/s]
    int iterations, least;       ///< rounding decides which seeds are not solved
  };
  const Method methods[] = {
      {"proximal Newton", [] { return make_proximal_newton(); }, 1e-8, 1e-4, 400, 19},
      {"bursts", [] { return make_newton_burst(); }, 1e-10, 1e-4, 6000, 18},
      {"at once", [] { return make_newton_burst(/*begins_with_sweeps=*/false); }, 1e-10, 1e-2,
       100000, 18}};
  for (const Method& method : methods) {
    int count = 0;
    for (std::uint64_t seed = 1; seed <= 20; ++seed) {
      const Budget budget{
          .tolerance = method.tolerance, .max_iterations = method.iterations, .max_seconds = 20.0};
      const SolverRun run = judged_by(method.make(), deficient(seed), budget);
      CAPTURE(method.name, seed, run.solved.iterations, run.error.natural_map_rms);
      CHECK(run.error.natural_map_rms < method.farthest);
      CHECK(run.is_solved() == (run.solved.reason == StopReason::reached_tolerance));
      count += run.is_solved();
    }
    CAPTURE(method.name);
    CHECK(count >= method.least);
  }
}

TEST_CASE("near a solution Newton's steps are quadratic, at it there are none", "[factors]") {
  const KnownSolution known = make_known_solution({.bodies = 40, .contacts = 30});
  const Budget budget{.tolerance = 1e-7};
  for (const double away : {0.0, 0.001}) {
    const SolverRun run = judged_by(make_newton(ContactEquation::alart_curnier), known.problem,
                                    budget, (1.0 + away) * known.r);
    CHECK(run.is_solved());
    CHECK(run.solved.iterations <= (away > 0.0 ? 2 : 0));
  }
}

TEST_CASE("the proximal Newton sweeps a warm start as well, and never loses it", "[factors]") {
  const KnownSolution known = make_known_solution({.bodies = 60, .contacts = 90});
  const Budget budget{.tolerance = 1e-6, .max_iterations = 50};
  for (const bool accelerated : {false, true}) {
    const ProximalNewtonSettings settings{.start_sweeps = 2000, .accelerated = accelerated};
    // Sweeps are enough, and do not count as iterations.
    const SolverRun run =
        judged_by(make_proximal_newton(settings), known.problem, budget, 0.5 * known.r);
    CHECK(run.is_solved());
    CHECK(run.solved.iterations == 0);
    const SolverRun there =
        judged_by(make_proximal_newton(settings), known.problem, budget, known.r);
    CHECK(there.is_solved());
    CHECK(there.solved.impulses == known.r);
  }
}

TEST_CASE("where sweeps are enough newton_burst is nesterov_pgs, bit for bit", "[factors]") {
  const FrictionProblem problem = make_known_solution({.bodies = 60, .contacts = 90}).problem;
  const Budget budget{.tolerance = 1e-3, .max_iterations = 5000};
  const SolverRun by_sweeps = judged_by(make_nesterov_pgs(), problem, budget);
  const SolverRun run = judged_by(make_newton_burst(), problem, budget);
  REQUIRE(by_sweeps.is_solved());
  CHECK(run.is_solved());
  CHECK(run.solved.iterations == by_sweeps.solved.iterations);
  CHECK(run.solved.impulses == by_sweeps.solved.impulses);
}

TEST_CASE("newton_burst has the same bits on any number of threads", "[factors]") {
  const Budget budget{.tolerance = 1e-10, .max_iterations = 2000};
  Impulses alone;
  for (const int threads : {1, 2}) {
    auto solver = make_newton_burst(/*begins_with_sweeps=*/false);
    WorkerTeam team;
    team.resize(threads);
    solver->use_team(&team);
    const SolverRun run = judged_by(std::move(solver), deficient(3), budget);
    CHECK(run.is_solved());
    if (threads == 1) alone = run.solved.impulses;
    CHECK(run.solved.impulses == alone);
  }
}

TEST_CASE("what newton_burst can never reach ends as stalled", "[factors]") {
  const SolverRun run =
      judged_by(make_newton_burst(), deficient(2), {.tolerance = 0.0, .max_iterations = 1000000});
  CHECK(run.solved.reason == StopReason::stalled);
  CHECK(run.error.natural_map_rms < 1e-12);
}

TEST_CASE("newton_burst declines a stored W by name") {
  CHECK_THROWS_WITH(make_newton_burst()->prepare(only_delassus(deficient(1))),
                    Catch::Contains("newton_burst"));
}
