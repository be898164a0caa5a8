#include "solvers/backends/pyramid_lemke.hpp"

#include <cmath>

#include "platform/random.hpp"
#include "problems/algebra/known_solutions.hpp"
#include "solvers/backends/backends.hpp"
#include "tests/catch.hpp"
#include "tests/support/delassus_form.hpp"
#include "tests/support/solved.hpp"

using namespace ballast;

namespace {

/// A block on the ground that slides at 1 m/s into the direction `angle`: W = 1 / m, q_N = -g h.
FrictionProblem sliding_block(double angle) {
  return stored_problem({0.4}, Eigen::Matrix3d::Identity(),
                        Eigen::Vector3d(-0.1, std::cos(angle), std::sin(angle)));
}

LemkeState run(Lemke& lemke, const Eigen::MatrixXd& m, const Eigen::VectorXd& q, int& pivots) {
  lemke.begin(m, q);
  for (pivots = 0; lemke.state() == LemkeState::running; ++pivots) {
    REQUIRE(pivots < 10000);
    lemke.pivot();
  }
  return lemke.state();
}

Eigen::MatrixXd random_matrix(int rows, int columns, Random& random) {
  Eigen::MatrixXd x(rows, columns);
  for (double& entry : x.reshaped()) entry = random.uniform(-1, 1);
  return x;
}

}  // namespace

TEST_CASE("pyramid: along one of its directions it is Coulomb's law, between them less friction") {
  constexpr double half = M_PI / 8.0;
  for (const double turn : {0.0, 0.5}) {  // 0: along a direction, 1/2: half-way to the next
    const SolverRun run =
        judged_by(make_pyramid_lemke(), sliding_block(turn * 2.0 * half), Budget{});
    CAPTURE(turn, run.error.natural_map_rms);
    CHECK(run.solved.own_residual < 1e-12);
    CHECK(run.is_solved() == (turn == 0.0));
    // Opposite to the motion the hull of the directions reaches mu r_N cos(pi / 8).
    const Eigen::Vector2d motion(std::cos(turn * 2.0 * half), std::sin(turn * 2.0 * half));
    CHECK(-run.solved.impulses.tail<2>().dot(motion) ==
          Approx(0.4 * 0.1 * std::cos(2.0 * turn * half)));
  }
}

TEST_CASE("pyramid: its own law is solved on rank-deficient problems") {
  const FrictionProblem deficient =
      make_known_solution({.bodies = 8, .contacts = 30, .friction_min = 0.3}).problem;
  const SolverRun run = judged_by(make_pyramid_lemke(), deficient, Budget{});
  CHECK(run.solved.own_residual < 1e-9);
  CHECK(run.solved.reason == StopReason::stalled);
}

TEST_CASE("pyramid: a problem too large is declined by name") {
  const FrictionProblem large =
      make_known_solution({.bodies = 200, .contacts = 200, .friction_min = 0.1}).problem;
  CHECK_THROWS_WITH(make_pyramid_lemke()->prepare(large),
                    Catch::Contains("pyramid_lemke") && Catch::Contains("1000"));
}

TEST_CASE("lemke: positive semidefinite problems of any rank, degenerate ones too") {
  Random random(3);
  int pivots = 0;
  for (const int n : {1, 2, 5, 20, 60})
    for (const int rank : {0, 1, n / 2, n})
      for (const bool degenerate : {false, true}) {
        CAPTURE(n, rank, degenerate);
        const Eigen::MatrixXd root = random_matrix(n, rank, random);
        Eigen::MatrixXd m = root * root.transpose();
        const Eigen::MatrixXd other = random_matrix(n, n, random);
        m += other - other.transpose();  // monotone, not symmetric
        // Feasible by construction: w = m z + q >= 0 at a chosen z >= 0.
        Eigen::VectorXd z = random_matrix(n, 1, random).cwiseMax(0.0),
                        w = random_matrix(n, 1, random).cwiseMax(0.0);
        if (degenerate) {
          m = m.array().round();
          z.setZero();
          w = w.array().round();
          w[0] = 0.0;
        }
        const Eigen::VectorXd q = w - m * z;
        Lemke lemke;
        REQUIRE(run(lemke, m, q, pivots) == LemkeState::solved);
        const Eigen::VectorXd x = lemke.solution();
        CHECK(x.minCoeff() >= 0.0);
        CHECK(x.cwiseMin(m * x + q).lpNorm<Eigen::Infinity>() < 1e-8);
      }
}

TEST_CASE("lemke: a problem without solution ends in a ray") {
  Lemke lemke;
  int pivots = 0;
  CHECK(run(lemke, Eigen::MatrixXd::Zero(2, 2), Eigen::Vector2d(-1, 1), pivots) == LemkeState::ray);
  CHECK(pivots < 5);
}
