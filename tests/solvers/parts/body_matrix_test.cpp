// M + H^T E H by blocks, compared with dense matrices.

#include "solvers/parts/body_matrix.hpp"

#include "platform/random.hpp"
#include "problems/algebra/known_solutions.hpp"
#include "tests/catch.hpp"
#include "tests/problems/algebra/dense_oracle.hpp"

using namespace ballast;

namespace {

/// Unsymmetric, regular blocks. In those of one-row contacts only entry 0,0 may be read.
std::vector<Eigen::Matrix3d> some_gains(const FrictionProblem& problem) {
  std::vector<Eigen::Matrix3d> gain(problem.contact_count());
  double next = 0.53;  // logistic map
  for (int c = 0; c < problem.contact_count(); ++c) {
    for (double& x : gain[c].reshaped()) x = (next = 3.99 * next * (1.0 - next)) - 0.5;
    gain[c].diagonal().array() += 1.5;
  }
  return gain;
}

Eigen::MatrixXd dense_matrix(const FrictionProblem& problem,
                             const std::vector<Eigen::Matrix3d>& gain) {
  const Eigen::MatrixXd h = oracle::dense_h(problem);
  Eigen::MatrixXd middle = Eigen::MatrixXd::Zero(problem.row_count(), problem.row_count());
  for (int c = 0; c < problem.contact_count(); ++c) {
    const int first = problem.row_begin[c], rows = problem.contact_rows(c);
    middle.block(first, first, rows, rows) = gain[c].topLeftCorner(rows, rows);
  }
  return oracle::dense_mass(problem) + h.transpose() * middle * h;
}

/// The gains of contacts that are open, stick or slip by turns; those of slip are unsymmetric.
std::vector<Eigen::Matrix3d> mixed_gains(int contacts, double stiffness, std::uint64_t seed) {
  Random random(seed);
  std::vector<Eigen::Matrix3d> gains;
  for (int c = 0; c < contacts; ++c) {
    Eigen::Matrix3d k = Eigen::Matrix3d::Zero();
    if (c % 3 == 1) k = stiffness * Eigen::Matrix3d::Identity();
    if (c % 3 == 2) k << stiffness, 0, 0, 0.4 * stiffness, 0, 0, 0, 0, random.uniform();
    gains.push_back(k);
  }
  return gains;
}

}  // namespace

TEST_CASE("the matrix of bodies is that of its definition, for one set of gains after another",
          "[factors]") {
  for (const FrictionProblem& problem :
       {make_known_solution({.contacts = 80}).problem, oracle::mixed_problem()}) {
    BodyMatrix matrix;
    matrix.prepare(problem);
    std::vector<Eigen::Matrix3d> gain = some_gains(problem);
    const Eigen::VectorXd b = Eigen::VectorXd::LinSpaced(problem.dynamics.dof_count(), -1.0, 2.0);
    for (const double factor : {1.0, 30.0}) {
      for (Eigen::Matrix3d& block : gain) block *= factor;
      const Eigen::VectorXd exact = oracle::dense_solution(dense_matrix(problem, gain), b);
      REQUIRE(matrix.factor(gain));
      Eigen::VectorXd x = b;
      matrix.solve_once(x, x);
      CHECK((x - exact).norm() <= 1e-11 * exact.norm());
      REQUIRE(matrix.solve(gain, b, x));
      CHECK((x - exact).norm() <= 1e-12 * exact.norm());
    }
  }
}

TEST_CASE("where a pivot vanishes rows are exchanged, and a singular matrix is reported",
          "[factors]") {
  // Two bodies of one unknown and mass 2: one contact joins them, one holds the second; H = 1.
  FrictionProblem problem;
  problem.has_dynamics = true;
  const Eigen::MatrixXd one = Eigen::MatrixXd::Ones(1, 1);
  for (int b = 0; b < 2; ++b) problem.dynamics.add_body(2.0 * one);
  problem.add_contact(0, 1, 0.0, one, one);
  problem.add_contact(1, -1, 0.0, one, {});
  problem.dynamics.v_free = problem.dynamics.bias = Eigen::VectorXd::Zero(2);
  BodyMatrix matrix;
  matrix.prepare(problem);
  const Eigen::Vector2d b(1.0, 3.0);
  Eigen::VectorXd x;
  const auto gains = [](double first, double second) {
    return std::vector<Eigen::Matrix3d>{first * Eigen::Matrix3d::Identity(),
                                        second * Eigen::Matrix3d::Identity()};
  };
  // [2 + e1, e1; e1, 2 + e1 + e2]: e1 = -2, e2 = 0 leaves zeros on the diagonal.
  CHECK_FALSE(matrix.factor(gains(-2.0, 0.0)));
  REQUIRE(matrix.solve(gains(-2.0, 0.0), b, x));
  CHECK(x[0] == Approx(-1.5));
  CHECK(x[1] == Approx(-0.5));
  // e1 = -1, e2 = 0: [1, -1; -1, 1].
  CHECK_FALSE(matrix.solve(gains(-1.0, 0.0), b, x));
}

TEST_CASE("stiff contacts beside open ones are solved as in a dense matrix", "[factors]") {
  BodyMatrix matrix;
  for (const int bodies : {1, 5, 30})
    for (const double stiffness : {1.0, 1e5}) {
      CAPTURE(bodies, stiffness);
      const FrictionProblem problem =
          make_known_solution({.bodies = bodies, .contacts = 3 * bodies, .mass_ratio = 10.0})
              .problem;
      matrix.prepare(problem);
      const std::vector<Eigen::Matrix3d> gains = mixed_gains(problem.contact_count(), stiffness, 3);
      REQUIRE(matrix.factor(gains));
      const Eigen::MatrixXd a = dense_matrix(problem, gains);
      const Eigen::VectorXd b = Eigen::VectorXd::LinSpaced(a.rows(), -1.0, 1.0);
      Eigen::VectorXd x;
      matrix.solve_once(b, x);
      CHECK((a * x - b).norm() < 1e-10 * b.norm());
      CHECK((x - oracle::dense_solution(a, b)).norm() < 1e-9 * x.norm());
    }
}
