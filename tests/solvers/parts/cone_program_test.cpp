#include "solvers/parts/cone_program.hpp"

#include <cmath>

#include "problems/algebra/contact_error.hpp"
#include "problems/algebra/known_solutions.hpp"
#include "tests/catch.hpp"
#include "tests/problems/algebra/dense_oracle.hpp"

using namespace ballast;

namespace {

Eigen::VectorXd waves(int rows) {
  Eigen::VectorXd x(rows);
  for (int i = 0; i < rows; ++i) x[i] = std::sin(1.3 * i + 0.2);
  return x;
}

/// The energy whose minimum over the cones is the program's.
double energy(const ConeProgram& program, const Eigen::VectorXd& x) {
  return 0.5 * x.dot(program.w * x) + x.dot(program.q);
}

}  // namespace

TEST_CASE("the program's units: blocks of largest eigenvalue one, q of largest entry one") {
  const FrictionProblem problem = oracle::mixed_problem();
  ConeProgram program;
  program.take(problem);
  CHECK(program.contact_count() == 6);  // one of seven does not move
  CHECK(program.q.lpNorm<Eigen::Infinity>() == Approx(1.0));
  const Eigen::MatrixXd w(program.w);
  CHECK((w - w.transpose()).norm() == 0.0);
  for (int k = 0; k < program.contact_count(); ++k) {
    const int rows = program.row_begin[k + 1] - program.row_begin[k];
    CHECK(program.has_friction(k) == (rows == 3));
    const Eigen::MatrixXd block = w.block(program.row_begin[k], program.row_begin[k], rows, rows);
    CHECK(Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(block).eigenvalues().maxCoeff() ==
          Approx(1.0));
  }
}

TEST_CASE("impulses there and back, and the same velocities in other units") {
  const FrictionProblem problem = oracle::mixed_problem();
  ConeProgram program;
  program.take(problem);
  const Eigen::VectorXd x = waves(program.row_count());
  const Eigen::VectorXd r = program.to_rows(x);
  CHECK((program.from_rows(r) - x).norm() <= 1e-14 * x.norm());
  // x . (W x + q) is the work r . u: what is minimised is an energy, in one unit for all rows.
  const Eigen::VectorXd u = program.moving().w * r + program.moving().q;
  const double unit = r.dot(program.moving().q) / x.dot(program.q);
  CHECK(x.dot(program.w_as_is * x + program.q) == Approx(r.dot(u) / unit));
}

TEST_CASE("polar coordinates: the cone and back, and gradients by differences") {
  ConeProgram program;
  program.take(oracle::mixed_problem());
  Eigen::VectorXd y = 0.3 * waves(program.row_count());
  for (int k = 0; k < program.contact_count(); ++k) y[program.row_begin[k]] = 0.5 + 0.1 * k;
  const Eigen::VectorXd x = program.from_polar(y);
  for (int k = 0; k < program.contact_count(); ++k)
    if (program.has_friction(k))
      CHECK(x.segment<2>(program.row_begin[k] + 1).norm() <
            program.friction[k] * x[program.row_begin[k]]);
  const Eigen::VectorXd u = Eigen::VectorXd::Zero(program.row_count());
  CHECK((program.to_polar(x, u, 1e-3, 0.99) - y).norm() <= 1e-14 * y.norm());

  const Eigen::VectorXd slope = program.polar_gradient(y, program.w * x + program.q);
  for (int i = 0; i < program.row_count(); ++i) {
    const Eigen::VectorXd step = 1e-6 * Eigen::VectorXd::Unit(program.row_count(), i);
    const double difference = (energy(program, program.from_polar(y + step)) -
                               energy(program, program.from_polar(y - step))) /
                              2e-6;
    CHECK(slope[i] == Approx(difference).margin(1e-8));
  }
}

TEST_CASE("outside the cone, to_polar comes as near as it may; at its apex it opposes the motion") {
  ConeProgram program;
  program.take(
      make_known_solution({.bodies = 4, .contacts = 2, .frictionless_fraction = 0.0}).problem);
  REQUIRE(program.has_friction(0));
  Eigen::VectorXd x = Eigen::VectorXd::Zero(program.row_count()), u = x;
  x.head<3>() << 1.0, 100.0, 0.0;
  u.segment<3>(3) << 0.0, 0.0, 2.0;
  const Eigen::VectorXd y = program.to_polar(x, u, 0.25, 0.9);
  CHECK((y.head<3>() - Eigen::Vector3d(1.0, 0.9, 0.0)).norm() <= 1e-14);
  CHECK((y.segment<3>(3) - Eigen::Vector3d(0.25, 0.0, -0.5)).norm() <= 1e-14);
}

TEST_CASE("a convex solver with the s-update around it comes to Coulomb's law") {
  const KnownSolution known = make_known_solution({.bodies = 20, .contacts = 15});
  ConeProgram program;
  program.take(known.problem);
  // Projected gradient, to the end: slow, obvious.
  const auto convex = [&](const ConeRequest& request, RoundAnswer& answer) {
    Eigen::VectorXd x = request.start;
    for (int k = 0; k < 3000; ++k) {
      x -= 0.2 * (program.w * x + request.q);
      program.project(x);
    }
    answer.x = x;
  };
  const Solved solved = program.solve(known.problem, Impulses::Zero(known.problem.row_count()),
                                      {.tolerance = 1e-6, .max_iterations = 60}, 20, convex);
  CHECK(solved.reason == StopReason::reached_tolerance);
  CHECK(contact_error(known.problem, solved.impulses).natural_map_rms <= 1e-6);
}
