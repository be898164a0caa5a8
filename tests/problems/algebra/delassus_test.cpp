#include "problems/algebra/delassus.hpp"

#include "problems/algebra/known_solutions.hpp"
#include "tests/catch.hpp"
#include "tests/problems/algebra/dense_oracle.hpp"
#include "tests/support/delassus_form.hpp"

using namespace ballast;

namespace {

void check_against_dense(const FrictionProblem& problem) {
  const Eigen::MatrixXd w = oracle::dense_delassus(problem);
  for (const FrictionProblem& form : {problem, only_delassus(problem)}) {
    CHECK_NOTHROW(form.validate());
    CHECK((Eigen::MatrixXd(delassus_matrix(form)) - w).norm() < 1e-12 * w.norm());
    std::vector<Eigen::Matrix3d> diagonal;
    delassus_diagonal(form, diagonal);
    REQUIRE(diagonal.size() == form.friction.size());
    for (int c = 0; c < form.contact_count(); ++c) {
      const int first = form.row_begin[c], rows = form.contact_rows(c);
      Eigen::Matrix3d expected = Eigen::Matrix3d::Zero();
      expected.topLeftCorner(rows, rows) = w.block(first, first, rows, rows);
      CHECK((diagonal[c] - expected).norm() <= 1e-13 * w.norm());
      CHECK((diagonal[c] - diagonal[c].transpose()).norm() <= 1e-15 * w.norm());
    }
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

TEST_CASE("a mass that is not positive definite is refused by name") {
  FrictionProblem problem = oracle::mixed_problem();
  problem.dynamics.mass.back() = -1.0;
  std::vector<Eigen::Matrix3d> diagonal;
  CHECK_THROWS_AS(delassus_diagonal(problem, diagonal), InvalidProblem);
}
