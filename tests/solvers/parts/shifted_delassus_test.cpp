#include "solvers/parts/shifted_delassus.hpp"

#include "problems/algebra/known_solutions.hpp"
#include "tests/catch.hpp"
#include "tests/problems/algebra/dense_oracle.hpp"
#include "tests/support/delassus_form.hpp"

using namespace ballast;

namespace {

/// Symmetric positive definite blocks of very different sizes.
std::vector<Eigen::Matrix3d> blocks(const FrictionProblem& problem, double spread) {
  std::vector<Eigen::Matrix3d> sigma(problem.contact_count());
  for (int c = 0; c < problem.contact_count(); ++c) {
    const Eigen::Vector3d v(1.0, std::sin(c), std::cos(2.0 * c));
    sigma[c] = std::pow(spread, std::sin(3.0 * c)) *
               (v * v.transpose() + 0.1 * Eigen::Matrix3d::Identity());
    if (problem.contact_rows(c) == 1) sigma[c] = sigma[c](0, 0) * Eigen::Matrix3d::Identity();
  }
  return sigma;
}

bool factor(ShiftedDelassus& system, const std::vector<Eigen::Matrix3d>& sigma) {
  system.sigma = sigma;
  for (std::size_t c = 0; c < sigma.size(); ++c) system.shift[c] = sigma[c].inverse();
  return system.factor();
}

Eigen::MatrixXd shifted(const FrictionProblem& problem, Eigen::MatrixXd w,
                        const std::vector<Eigen::Matrix3d>& sigma) {
  for (int c = 0; c < problem.contact_count(); ++c) {
    const int first = problem.row_begin[c], rows = problem.contact_rows(c);
    if (rows == 3) w.block<3, 3>(first, first) += sigma[c].inverse();
    if (rows == 1) w(first, first) += 1.0 / sigma[c](0, 0);
  }
  return w;
}

Eigen::VectorXd sample(int rows) { return Eigen::VectorXd::LinSpaced(rows, -1.0, 2.0); }

}  // namespace

TEST_CASE("the shifted system is solved in both forms, singular W or not", "[factors]") {
  for (const FrictionProblem& dynamics :
       {make_known_solution({.contacts = 80}).problem, oracle::mixed_problem()}) {
    const auto sigma = blocks(dynamics, 100.0);
    const Eigen::VectorXd b = sample(dynamics.row_count());
    const Eigen::VectorXd exact =
        oracle::dense_solution(shifted(dynamics, oracle::dense_delassus(dynamics), sigma), b);
    for (const FrictionProblem& problem : {dynamics, only_delassus(dynamics)}) {
      ContactOperator w;
      w.prepare(problem);
      ShiftedDelassus system;
      system.prepare(w);
      REQUIRE(factor(system, sigma));
      Eigen::VectorXd x;
      system.solve(b, x);
      CHECK((x - exact).norm() <= 1e-9 * exact.norm());
      system.solve(b, x, 2);
      CHECK((x - exact).norm() <= 1e-11 * exact.norm());
      REQUIRE(factor(system, blocks(dynamics, 2.0)));  // the same pattern again
    }
  }
}

TEST_CASE("an unsymmetric stored W is taken as it is", "[factors]") {
  FrictionProblem problem =
      only_delassus(make_known_solution({.bodies = 20, .contacts = 15}).problem);
  Eigen::MatrixXd dense = problem.delassus.w;
  for (int i = 0; i < dense.rows(); ++i)
    for (int j = 0; j < i; ++j) dense(i, j) *= 1.05;
  problem.delassus.w = dense.sparseView();
  const auto sigma = blocks(problem, 10.0);
  ContactOperator w;
  w.prepare(problem);
  ShiftedDelassus system;
  system.prepare(w);
  REQUIRE(factor(system, sigma));
  const Eigen::VectorXd b = sample(problem.row_count());
  Eigen::VectorXd x;
  system.solve(b, x);
  CHECK((shifted(problem, dense, sigma) * x - b).norm() <= 1e-11 * b.norm());
}
