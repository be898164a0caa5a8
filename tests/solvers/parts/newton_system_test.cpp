#include "solvers/parts/newton_system.hpp"

#include "problems/algebra/delassus.hpp"
#include "problems/algebra/known_solutions.hpp"
#include "tests/catch.hpp"
#include "tests/problems/algebra/dense_oracle.hpp"
#include "tests/support/delassus_form.hpp"

using namespace ballast;

namespace {

/// Blocks without a pattern, regular together with alpha.
std::vector<ContactLinearisation> some_blocks(const FrictionProblem& problem) {
  std::vector<ContactLinearisation> linear(problem.contact_count());
  double next = 0.41;  // logistic map
  const auto number = [&next] { return (next = 3.99 * next * (1.0 - next)) - 0.5; };
  for (int c = 0; c < problem.contact_count(); ++c) {
    ContactLinearisation& l = linear[c];
    for (double& x : l.f) x = number();
    for (double& x : l.by_r.reshaped()) x = 0.3 * number();
    for (double& x : l.by_u.reshaped()) x = 0.3 * number();
    l.by_r.diagonal().array() += 1.0;
    l.by_u.diagonal().array() += 1.0;
    if (problem.contact_rows(c) == 3) continue;
    l.f.tail<2>().setZero();  // one row: padded
    l.by_r = Eigen::Vector3d(l.by_r(0, 0), 1.0, 1.0).asDiagonal();
    l.by_u = Eigen::Vector3d(l.by_u(0, 0), 0.0, 0.0).asDiagonal();
  }
  return linear;
}

/// (by_r + by_u (W + alpha)) dr + f, in dense matrices.
double residual(const FrictionProblem& problem, const Eigen::MatrixXd& w,
                const std::vector<ContactLinearisation>& linear, const std::vector<double>& alpha,
                const Impulses& dr) {
  const Eigen::VectorXd du = w * dr;
  double sum = 0.0;
  for (int c = 0; c < problem.contact_count(); ++c) {
    const int begin = problem.row_begin[c], rows = problem.contact_rows(c);
    const Eigen::VectorXd r = dr.segment(begin, rows), u = du.segment(begin, rows);
    const Eigen::VectorXd left = linear[c].by_r.topLeftCorner(rows, rows) * r +
                                 linear[c].by_u.topLeftCorner(rows, rows) * (u + alpha[c] * r) +
                                 linear[c].f.head(rows);
    sum += left.squaredNorm();
  }
  return std::sqrt(sum);
}

}  // namespace

TEST_CASE("a Newton system is solved in both forms, for one set of blocks after another",
          "[factors]") {
  for (const FrictionProblem& dynamics :
       {make_known_solution({.contacts = 80}).problem, oracle::mixed_problem()}) {
    const Eigen::MatrixXd w = oracle::dense_delassus(dynamics);
    std::vector<ContactLinearisation> linear = some_blocks(dynamics);
    for (const bool has_dynamics : {true, false}) {
      const FrictionProblem problem = has_dynamics ? dynamics : only_delassus(dynamics);
      ContactOperator op;
      op.prepare(problem);
      NewtonSystem system;
      system.prepare(op);
      for (const double weight : {1e-2, 1.0}) {
        CAPTURE(has_dynamics, weight);
        const std::vector<double> alpha(problem.contact_count(), weight);
        Impulses dr;
        REQUIRE(system.solve(op, linear, alpha, dr));
        CHECK(residual(dynamics, w, linear, alpha, dr) <= 1e-10 * (1.0 + dr.norm()));
        CHECK(dr.norm() > 0.0);
      }
    }
  }
}

TEST_CASE("without alpha the stored form takes blocks that the dynamics form cannot", "[factors]") {
  // A sticking contact: by_r = 0, and B = alpha by_u is singular for alpha = 0.
  const FrictionProblem dynamics = make_known_solution({.bodies = 6, .contacts = 3}).problem;
  const std::vector<ContactLinearisation> stick(
      3, {Eigen::Vector3d::Ones(), Eigen::Matrix3d::Zero(), Eigen::Matrix3d::Identity()});
  const std::vector<double> none(3, 0.0);
  Impulses dr;
  for (const bool has_dynamics : {true, false}) {
    const FrictionProblem problem = has_dynamics ? dynamics : only_delassus(dynamics);
    ContactOperator op;
    op.prepare(problem);
    NewtonSystem system;
    system.prepare(op);
    CHECK(system.solve(op, stick, none, dr) == !has_dynamics);
  }
}

TEST_CASE("bodies' matrices whose rows must be exchanged are solved as well", "[factors]") {
  // Two masses of 1 that one frictionless contact joins: M + E [1 -1; -1 1] with E = -1 has a zero
  // for its first pivot. E = by_u / (by_r + alpha by_u).
  FrictionProblem problem;
  problem.has_dynamics = true;
  DynamicsForm& d = problem.dynamics;
  d.mass = {1.0, 1.0};
  d.dof_begin = d.mass_begin = {0, 1, 2};
  d.v_free = Eigen::Vector2d::Zero();
  d.bias = Eigen::VectorXd::Zero(1);
  d.body_a = {0};
  d.body_b = {1};
  d.h = {-1.0, 1.0};
  d.h_begin = {0, 2};
  problem.row_begin = {0, 1};
  problem.friction = {0.0};
  const std::vector<ContactLinearisation> linear{{Eigen::Vector3d(0.5, 0.0, 0.0),
                                                  Eigen::Vector3d(-2.0, 1.0, 1.0).asDiagonal(),
                                                  Eigen::Vector3d(1.0, 0.0, 0.0).asDiagonal()}};
  ContactOperator op;
  op.prepare(problem);
  NewtonSystem system;
  system.prepare(op);
  Impulses dr;
  REQUIRE(system.solve(op, linear, {1.0}, dr));
  CHECK(dr[0] == Approx(-0.5));  // by_r + by_u (W + alpha) = -2 + 2 + 1
}
