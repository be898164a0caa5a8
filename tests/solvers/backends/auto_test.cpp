#include "solvers/backends/auto.hpp"

#include <utility>

#include "problems/algebra/known_solutions.hpp"
#include "problems/algebra/pile_problems.hpp"
#include "solvers/backends/nesterov_pgs.hpp"
#include "solvers/seam/fclib_stop.hpp"
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

struct Work {
  int sweeps, factorisations;
};

/// What auto needs until Siconos' measure is below `tolerance`.
Work work_to(const FrictionProblem& problem, double tolerance) {
  FclibStop stop(problem, tolerance);
  int factorisations = 0;
  const SolverRun run = solved(make_auto(), problem,
                               {.tolerance = 0.0,
                                .max_iterations = 1 << 30,
                                .fclib = &stop,
                                .factorisations = &factorisations});
  CHECK(run.is_solved());
  return {run.solved.iterations - factorisations, factorisations};
}

}  // namespace

TEST_CASE("where iterations are scarce, sweeps leave them to Newton while there are enough",
          "[factors]") {
  const Budget scarce{.tolerance = 1e-7, .max_iterations = 300};
  int by_sweeps = 0, by_auto = 0;
  for (const bool is_stored : {false, true})
    for (std::uint64_t seed = 1; seed <= 5; ++seed) {
      const FrictionProblem problem = heavy_pile(seed, is_stored);
      const SolverRun run = solved(make_auto(), problem, scarce);
      CHECK(run.solved.iterations <= scarce.max_iterations);
      by_auto += run.is_solved();
      by_sweeps += solved(make_nesterov_pgs(), problem, scarce).is_solved();
    }
  CHECK(by_auto == 10);
  CHECK(by_sweeps < 5);
}

TEST_CASE("of thousands of iterations sweeps that arrive take what they need; the rest is Newton's",
          "[factors]") {
  const auto pile = [](double redundancy, double mass_ratio) {
    return make_pile(
        {.contacts = 1500, .redundancy = redundancy, .mass_ratio = mass_ratio, .seed = 3});
  };
  int factorisations = 0;
  const Budget thousands{
      .tolerance = 1e-7, .max_iterations = 10000, .factorisations = &factorisations};
  CHECK(solved(make_auto(), pile(0.5, 100.0), thousands).is_solved());
  CHECK(factorisations == 0);
  CHECK_FALSE(solved(make_nesterov_pgs(), pile(0.8, 1000.0), thousands).is_solved());
  CHECK(solved(make_auto(), pile(0.8, 1000.0), thousands).is_solved());
  CHECK(factorisations > 0);
}

TEST_CASE("sweeps that will arrive keep the iterations, though a quarter of them is used",
          "[factors]") {
  // Sweeps need 40 % of them. Once a quarter was used, every iteration counted as much as another:
  // factorisations took over.
  const FrictionProblem pile =
      make_pile({.contacts = 1500, .redundancy = 0.5, .mass_ratio = 100.0, .seed = 3});
  const Budget plenty{.tolerance = 1e-7, .max_iterations = 10000};
  const int needed = solved(make_nesterov_pgs(), pile, plenty).solved.iterations;
  int factorisations = 0;
  const Budget enough{
      .tolerance = 1e-7, .max_iterations = needed * 5 / 2, .factorisations = &factorisations};
  REQUIRE(enough.max_iterations > 500);
  CHECK(solved(make_auto(), pile, enough).is_solved());
  CHECK(factorisations == 0);
}

TEST_CASE("the turns are counted in work, not by the clock: the same bits every time",
          "[factors]") {
  const FrictionProblem problem = heavy_pile(7, true);
  const Budget budget{.tolerance = 1e-9, .max_iterations = 20000};
  const SolverRun first = solved(make_auto(), problem, budget),
                  second = solved(make_auto(), problem, budget);
  CHECK(first.is_solved());
  CHECK(first.solved.iterations == second.solved.iterations);
  CHECK(first.solved.impulses == second.solved.impulses);
}

TEST_CASE("where sweeps go round and a Newton step costs few of them, Newton's turn comes soon",
          "[factors]") {
  // Six contacts. By turns of hundreds of sweeps without plain Newton it took 758 iterations.
  const Work work = work_to(make_pile(random_pile(203, 10)), 1e-4);
  CHECK(work.sweeps < 350);
  CHECK(work.factorisations < 10);
}

TEST_CASE("where a factorisation fills, other sweeps are tried before it", "[factors]") {
  // Bodies that touch at random: a Newton step costs as much as hundreds of sweeps, which counting
  // bodies does not tell.
  int sweeps = 0;
  for (const std::uint64_t seed : {1, 2, 3}) {
    const Work work =
        work_to(make_known_solution({.bodies = 400, .contacts = 1000, .seed = seed}).problem, 1e-8);
    CHECK(work.factorisations == 0);
    sweeps += work.sweeps;
  }
  CHECK(sweeps < 1800);
}

TEST_CASE("where a step costs hundreds of sweeps, those get their share beside bursts",
          "[factors]") {
  // Trusted as over piles, bursts took 92 factorisations.
  const FrictionProblem graph =
      make_known_solution({.bodies = 100, .contacts = 300, .mass_ratio = 1e2, .seed = 72001})
          .problem;
  CHECK(work_to(graph, 1e-8).factorisations < 60);
}

TEST_CASE("bursts of sweeps between Newton steps go on though their error stands for long",
          "[factors]") {
  // Left after the first steps for plain and proximal Newton: 49 factorisations and 1885 sweeps.
  const Work work = work_to(make_pile(random_pile(22, 1000)), 1e-8);
  CHECK(work.factorisations < 47);
  CHECK(work.sweeps < 700);
}

TEST_CASE("of few contacts Newton's turn comes soon, and bursts are as short as steps are cheap",
          "[factors]") {
  // With 160 sweeps before the first step and 50 after every one: 7512 sweeps.
  Work all{0, 0};
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    const Work work = work_to(heavy_pile(seed, false), 1e-8);
    all.sweeps += work.sweeps;
    all.factorisations += work.factorisations;
  }
  CHECK(all.sweeps < 2500);
  CHECK(all.factorisations < 350);
}

TEST_CASE("with a stored W plain Newton's turn comes after proximal steps", "[factors]") {
  // Where it came first: 98 and 140 factorisations.
  for (const std::uint64_t seed : {12, 29}) {
    const PileSettings settings = random_pile(seed, 1000);
    REQUIRE(settings.is_stored);
    CHECK(work_to(make_pile(settings), 1e-8).factorisations < 85);
  }
}

TEST_CASE("sweeps that come down slowly are not left early for Newton", "[factors]") {
  // With little trust in them: 29 factorisations.
  const FrictionProblem problem =
      make_known_solution({.bodies = 100, .contacts = 300, .mass_ratio = 1e2, .seed = 4}).problem;
  const Work work = work_to(problem, 1e-8);
  CHECK(work.factorisations == 0);
  CHECK(work.sweeps < 2600);
}
