#include "solvers/seam/moving_contacts.hpp"

#include <Eigen/Eigenvalues>

#include "tests/catch.hpp"
#include "tests/problems/algebra/dense_oracle.hpp"

using namespace ballast;

TEST_CASE("the contacts that move, as the dense operator has them") {
  const FrictionProblem problem = oracle::mixed_problem();  // contact 4: nothing moves
  MovingContacts moving;
  moving.take(problem);
  CHECK(moving.contact == std::vector<int>{0, 1, 2, 3, 5, 6});
  CHECK(moving.row_begin == std::vector<int>{0, 3, 6, 7, 10, 13, 14});
  CHECK(moving.contact_count() == 6);
  CHECK(moving.row_count() == 14);
  CHECK(moving.rows(2) == 1);

  const Eigen::MatrixXd w = oracle::dense_delassus(problem);
  const Eigen::VectorXd q = oracle::dense_q(problem);
  std::vector<int> rows;
  for (const int c : moving.contact)
    for (int i = problem.row_begin[c]; i < problem.row_begin[c + 1]; ++i) rows.push_back(i);
  CHECK((Eigen::MatrixXd(moving.w) - w(rows, rows)).norm() <= 1e-12 * w.norm());
  CHECK((moving.q - q(rows)).norm() <= 1e-14 * q.norm());
  for (int k = 0; k < moving.contact_count(); ++k) {
    const int c = moving.contact[k];
    CHECK(moving.friction[k] == problem.friction[c]);
    const Eigen::MatrixXd block = w.block(problem.row_begin[c], problem.row_begin[c],
                                          problem.contact_rows(c), problem.contact_rows(c));
    const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> spectrum(block);
    CHECK(moving.lambda_max[k] == Approx(spectrum.eigenvalues().maxCoeff()));
  }
}

TEST_CASE("impulses there and back: what moves stays, what does not becomes zero") {
  const FrictionProblem problem = oracle::mixed_problem();
  MovingContacts moving;
  moving.take(problem);
  const Impulses r = Impulses::LinSpaced(problem.row_count(), 1.0, 2.0);
  Eigen::VectorXd x;
  moving.gather(problem, r, x);
  CHECK(x.size() == 14);
  Impulses back;
  moving.scatter(problem, x, back);
  Impulses expected = r;
  expected.segment(problem.row_begin[4], 3).setZero();
  CHECK(back == expected);
}

TEST_CASE("a problem without contacts, after one with some") {
  FrictionProblem problem = oracle::mixed_problem();
  MovingContacts moving;
  moving.take(problem);
  problem.clear();
  problem.has_dynamics = true;
  problem.dynamics.v_free.resize(0);
  problem.dynamics.bias.resize(0);
  moving.take(problem);
  CHECK(moving.contact_count() == 0);
  CHECK(moving.row_count() == 0);
}
