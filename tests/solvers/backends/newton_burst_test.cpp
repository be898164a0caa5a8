#include "solvers/backends/newton_burst.hpp"
#include "platform/worker_team.hpp"

#include "problems/algebra/known_solutions.hpp"
#include "solvers/backends/gauss_seidel.hpp"
#include "solvers/seam/run_solver.hpp"
#include "tests/catch.hpp"
#include "tests/support/delassus_form.hpp"

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

TEST_CASE("Newton with bursts closes on rank-deficient problems, nearly all", "[factors]") {
  int solved = 0;
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    const auto solver = make_newton_burst();
    const SolverRun run =
        SolverRunner().run(*solver, deficient(seed), {},
                           {.tolerance = 1e-10, .max_iterations = 6000, .max_seconds = 20.0});
    CAPTURE(seed, run.solved.iterations, run.error.natural_map_rms);
    CHECK(run.is_solved() == (run.solved.reason == StopReason::reached_tolerance));
    solved += run.is_solved();
  }
  CHECK(solved >= 18);  // seed by seed it is a matter of rounding which one stays
}

TEST_CASE("without sweeps worth the name Newton's steps carry the solve", "[factors]") {
  const auto solver = make_newton_burst({.start_sweeps = 5, .burst = 5});
  const SolverRun run = SolverRunner().run(
      *solver, deficient(1), {}, {.tolerance = 1e-10, .max_iterations = 500, .max_seconds = 20.0});
  CAPTURE(run.solved.iterations, run.error.natural_map_rms);
  CHECK(run.is_solved());
}

TEST_CASE("where sweeps are enough it is nesterov_pgs, bit for bit", "[factors]") {
  const FrictionProblem problem = make_known_solution({.bodies = 60, .contacts = 90}).problem;
  const Budget budget{.tolerance = 1e-3, .max_iterations = 5000};
  const auto sweeps = make_nesterov_pgs(), solver = make_newton_burst();
  const SolverRun by_sweeps = SolverRunner().run(*sweeps, problem, {}, budget);
  const SolverRun run = SolverRunner().run(*solver, problem, {}, budget);
  REQUIRE(by_sweeps.is_solved());
  CHECK(run.is_solved());
  CHECK(run.solved.iterations == by_sweeps.solved.iterations);
  CHECK(run.solved.impulses == by_sweeps.solved.impulses);
}

TEST_CASE("Newton takes over from sweeps to the same bits on any number of threads", "[factors]") {
  const Budget budget{.tolerance = 1e-10, .max_iterations = 2000};
  Impulses alone;
  for (const int threads : {1, 2}) {
    const auto solver = make_newton_burst({.start_sweeps = 20, .promised_sweeps = 10});
    WorkerTeam team;
    team.resize(threads);
    solver->use_team(&team);
    const SolverRun run = SolverRunner().run(*solver, deficient(3), {}, budget);
    CHECK(run.is_solved());
    if (threads == 1) alone = run.solved.impulses;
    CHECK(run.solved.impulses == alone);
  }
}

TEST_CASE("steps that must lower the error come first, and the walk where they are stuck",
          "[factors]") {
  int solved = 0;
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    CAPTURE(seed);
    const auto solver = make_newton_burst({.start_sweeps = 20, .promised_sweeps = 10});
    const SolverRun run = SolverRunner().run(*solver, deficient(seed), {},
                                             {.tolerance = 1e-10, .max_iterations = 100000});
    const bool arrived = run.solved.reason == StopReason::reached_tolerance;
    CHECK(run.is_solved() == arrived);
    solved += arrived;
  }
  CHECK(solved >= 9);
}

TEST_CASE("steps that lower the error end after their part", "[factors]") {
  // A tolerance of 0 is never met; the rounds before are the same, and there is no walk after them.
  const auto iterations_of = [](int descent_steps) {
    const auto solver = make_newton_burst({.start_sweeps = 20,
                                           .promised_sweeps = 10,
                                           .descent_steps = descent_steps,
                                           .most_steps = 0});
    return SolverRunner()
        .run(*solver, deficient(2), {}, {.tolerance = 0.0, .max_iterations = 100000})
        .solved.iterations;
  };
  const int rounds = iterations_of(0), some = iterations_of(7), most = iterations_of(60);
  CAPTURE(rounds, some, most);
  CHECK(some > rounds);
  CHECK(some <= rounds + 7 + NewtonBurstSettings{}.inner_steps);  // the last one is not cut short
  CHECK(most > some);
}

TEST_CASE("what can never be reached ends as stalled", "[factors]") {
  const auto solver = make_newton_burst({.most_steps = 100});
  const SolverRun run =
      SolverRunner().run(*solver, deficient(2), {}, {.tolerance = 0.0, .max_iterations = 1000000});
  CHECK(run.solved.reason == StopReason::stalled);
  CHECK(run.error.natural_map_rms < 1e-12);
}

TEST_CASE("a stored W is declined by name") {
  const auto solver = make_newton_burst();
  const FrictionProblem stored = only_delassus(deficient(1));
  CHECK_THROWS_WITH(solver->prepare(stored), Catch::Contains("newton_burst"));
}
