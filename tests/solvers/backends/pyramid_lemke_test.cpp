#include "solvers/backends/pyramid_lemke.hpp"

#include <cmath>

#include "problems/algebra/known_solutions.hpp"
#include "solvers/seam/run_solver.hpp"
#include "tests/catch.hpp"

using namespace ballast;

namespace {

/// A block on the ground that slides at 1 m/s into the direction `angle`: W = 1 / m, q_N = -g h.
FrictionProblem sliding_block(double angle) {
  FrictionProblem problem;
  problem.row_begin = {0, 3};
  problem.friction = {0.4};
  problem.has_delassus = true;
  problem.delassus.w.resize(3, 3);
  problem.delassus.w.setIdentity();
  problem.delassus.q = Eigen::Vector3d(-0.1, std::cos(angle), std::sin(angle));
  return problem;
}

}  // namespace

TEST_CASE("pyramid: along one of its directions it is Coulomb's law, between them less friction") {
  const Budget budget;
  for (const int sides : {4, 8})
    for (const double turn : {0.0, 0.5}) {  // 0: along a direction, 1/2: half-way to the next
      const double half = M_PI / sides;
      const auto solver = make_pyramid_lemke({.sides = sides});
      const SolverRun run =
          SolverRunner().run(*solver, sliding_block(turn * 2.0 * half), {}, budget);
      CAPTURE(sides, turn, run.error.natural_map_rms);
      CHECK(run.solved.own_residual < 1e-12);
      CHECK(run.is_solved() == (turn == 0.0));
      // Opposite to the motion the hull of the directions reaches mu r_N cos(pi / sides).
      const Eigen::Vector2d motion(std::cos(turn * 2.0 * half), std::sin(turn * 2.0 * half));
      CHECK(-run.solved.impulses.tail<2>().dot(motion) ==
            Approx(0.4 * 0.1 * std::cos(2.0 * turn * half)));
    }
}

TEST_CASE(
    "pyramid: its own law is solved on rank-deficient problems, and more sides come nearer to the "
    "cone") {
  double last = 1e30;
  for (const int sides : {4, 8, 16}) {
    KnownSolutionSettings settings;
    settings.contacts = 30;
    settings.bodies = 8;
    settings.friction_min = 0.3;
    const auto solver = make_pyramid_lemke({.sides = sides});
    const SolverRun run =
        SolverRunner().run(*solver, make_known_solution(settings).problem, {}, Budget{});
    CAPTURE(sides, run.solved.iterations, run.solved.own_residual, run.error.natural_map_rms);
    CHECK(run.solved.own_residual < 1e-9);
    CHECK(run.solved.reason == StopReason::stalled);
    CHECK(run.error.natural_map_rms < last);
    last = run.error.natural_map_rms;
  }
}

TEST_CASE("pyramid: a problem too large is declined by name") {
  KnownSolutionSettings settings;
  settings.bodies = 200;
  settings.contacts = 200;
  settings.friction_min = 0.1;
  try {
    make_pyramid_lemke()->prepare(make_known_solution(settings).problem);
    FAIL("no exception");
  } catch (const UnsupportedProblem& error) {
    CHECK(std::string(error.what()).find("pyramid_lemke") != std::string::npos);
    CHECK(std::string(error.what()).find("1000") != std::string::npos);
  }
}
