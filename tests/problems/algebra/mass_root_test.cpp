#include "problems/algebra/mass_root.hpp"

#include <Eigen/Dense>

#include "platform/random.hpp"
#include "tests/catch.hpp"

using namespace ballast;

namespace {

Eigen::MatrixXd random_mass(int dofs, bool diagonal, Random& random) {
  Eigen::MatrixXd a(dofs, dofs);
  for (double& x : a.reshaped()) x = random.uniform(-1, 1);
  Eigen::MatrixXd mass = a * a.transpose() + 0.1 * Eigen::MatrixXd::Identity(dofs, dofs);
  if (diagonal) mass = mass.diagonal().asDiagonal().toDenseMatrix();
  return 0.5 * (mass + mass.transpose());
}

template <int Rows>
Eigen::MatrixXd scaled(const MassRoot& root, const Eigen::MatrixXd& h) {
  Eigen::MatrixXd g(Rows, root.dofs);
  root.scaled_columns<Rows>(h.data(), [&](int k, const double* column) {
    for (int i = 0; i < Rows; ++i) g(i, k) = column[i];
  });
  return g;
}

}  // namespace

TEST_CASE("the mass root agrees with a dense Cholesky factor") {
  Random random(21);
  for (int dofs = 1; dofs <= 6; ++dofs)
    for (const bool diagonal : {true, false})
      for (int sample = 0; sample < 20; ++sample) {
        const Eigen::MatrixXd mass = random_mass(dofs, diagonal, random);
        MassRoot root;
        REQUIRE(root.factor(mass.data(), dofs));
        REQUIRE(root.diagonal == (diagonal || dofs == 1));
        const Eigen::MatrixXd l = mass.llt().matrixL();

        Eigen::VectorXd x = Eigen::VectorXd::LinSpaced(dofs, 0.5, 2.0), solution = x, product = x;
        root.solve(solution.data());
        root.multiply_upper(mass.data(), product.data());
        REQUIRE((mass * solution - x).norm() < 1e-12);
        REQUIRE((product - l.transpose() * x).norm() < 1e-13);

        const Eigen::MatrixXd h =
            Eigen::MatrixXd::NullaryExpr(3, dofs, [&] { return random.uniform(-1, 1); });
        REQUIRE((scaled<3>(root, h) * l.transpose() - h).norm() < 1e-13);
        const Eigen::MatrixXd row = h.row(0);
        REQUIRE((scaled<1>(root, row) * l.transpose() - row).norm() < 1e-13);
      }
}

TEST_CASE("what is not positive definite has no root") {
  MassRoot root;
  const double indefinite[] = {1, 2, 2, 1}, zero[] = {0}, negative[] = {1, 0, 0, -1},
               nan[] = {std::nan("")}, infinite[] = {HUGE_VAL};
  CHECK_FALSE(root.factor(indefinite, 2));
  CHECK_FALSE(root.factor(zero, 1));
  CHECK_FALSE(root.factor(negative, 2));
  CHECK_FALSE(root.factor(nan, 1));
  CHECK_FALSE(root.factor(infinite, 1));
}
