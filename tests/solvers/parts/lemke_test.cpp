#include "solvers/parts/lemke.hpp"

#include "platform/random.hpp"
#include "tests/catch.hpp"

using namespace ballast;

namespace {

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
