#include "problems/algebra/delassus.hpp"

#include "problems/algebra/known_solutions.hpp"
#include "tests/catch.hpp"
#include "tests/problems/algebra/dense_oracle.hpp"
#include "tests/support/delassus_form.hpp"

using namespace ballast;

namespace {

void check_against_dense(const FrictionProblem& problem) {
  const Eigen::MatrixXd w = oracle::dense_delassus(problem);
  CHECK((Eigen::MatrixXd(delassus_matrix(problem)) - w).norm() < 1e-12 * w.norm());
  std::vector<Eigen::Matrix3d> diagonal;
  delassus_diagonal(problem, diagonal);
  REQUIRE(diagonal.size() == problem.friction.size());
  for (int c = 0; c < problem.contact_count(); ++c) {
    const int first = problem.row_begin[c], rows = problem.contact_rows(c);
    Eigen::Matrix3d expected = Eigen::Matrix3d::Zero();
    expected.topLeftCorner(rows, rows) = w.block(first, first, rows, rows);
    CHECK((diagonal[c] - expected).norm() <= 1e-13 * w.norm());
    CHECK(diagonal[c] == diagonal[c].transpose());
  }
}

}  // namespace

TEST_CASE("the Delassus operator agrees with dense matrices") {
  check_against_dense(oracle::mixed_problem());
  FrictionProblem diagonal_masses = make_known_solution({.mass_ratio = 1e3}).problem;
  check_against_dense(diagonal_masses);
  for (std::size_t k = 0; k < diagonal_masses.dynamics.mass.size(); ++k)
    if (k % 36 % 7 != 0) diagonal_masses.dynamics.mass[k] = 0.0;
  check_against_dense(diagonal_masses);
}

TEST_CASE("bodies that share no contact do not meet in W") {
  const SparseRows w =
      delassus_matrix(make_known_solution({.bodies = 200, .contacts = 100}).problem);
  CHECK(w.nonZeros() < w.rows() * w.cols() / 10);
}

TEST_CASE("the added form is the same problem") {
  FrictionProblem problem = oracle::mixed_problem();
  add_delassus_form(problem);
  REQUIRE(problem.has_delassus);
  CHECK_NOTHROW(problem.validate());
  CHECK((problem.delassus.q - oracle::dense_q(problem)).norm() < 1e-13);

  std::vector<Eigen::Matrix3d> computed, stored;
  delassus_diagonal(problem, computed);
  problem.has_dynamics = false;
  delassus_diagonal(problem, stored);
  for (int c = 0; c < problem.contact_count(); ++c)
    CHECK((computed[c] - stored[c]).norm() <= 1e-14 * computed[c].norm());
  problem.delassus.w.coeffRef(0, 0) = 42.0;  // the stored operator is what is returned
  CHECK(delassus_matrix(problem).coeff(0, 0) == 42.0);
}

TEST_CASE("a mass that is not positive definite is refused by name") {
  FrictionProblem problem = oracle::mixed_problem();
  problem.dynamics.mass.back() = -1.0;
  std::vector<Eigen::Matrix3d> diagonal;
  CHECK_THROWS_AS(delassus_diagonal(problem, diagonal), InvalidProblem);
}
