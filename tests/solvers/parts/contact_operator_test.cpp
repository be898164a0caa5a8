#include "solvers/parts/contact_operator.hpp"

#include "problems/algebra/contact_error.hpp"
#include "problems/algebra/known_solutions.hpp"
#include "tests/catch.hpp"
#include "tests/problems/algebra/dense_oracle.hpp"
#include "tests/support/delassus_form.hpp"

using namespace ballast;

namespace {

/// Both forms of a problem with all kinds of contacts and bodies, and of a rank-deficient one.
std::vector<FrictionProblem> problems() {
  std::vector<FrictionProblem> all{oracle::mixed_problem(),
                                   make_known_solution({.contacts = 80}).problem};
  for (int k = 0; k < 2; ++k) all.push_back(only_delassus(all[k]));
  return all;
}

/// Impulses, some inside their cones, some outside.
Impulses some_impulses(const FrictionProblem& problem) {
  Impulses r(problem.row_count());
  for (int i = 0; i < r.size(); ++i) r[i] = std::sin(1.7 * i) + (i % 3 == 0 ? 0.5 : 0.0);
  return r;
}

}  // namespace

TEST_CASE("both forms of the operator multiply as the dense W does") {
  const std::vector<FrictionProblem> all = problems();
  for (std::size_t k = 0; k < all.size(); ++k) {
    const FrictionProblem& dense = all[k % 2];
    const Eigen::MatrixXd w = oracle::dense_delassus(dense);
    ContactOperator op;
    op.prepare(all[k]);
    const Impulses r = some_impulses(dense);
    Eigen::VectorXd u, product;
    op.velocity(r, u);
    op.multiply(r, product);
    CHECK((product - w * r).norm() <= 1e-12 * product.norm());
    CHECK((u - w * r - oracle::dense_q(dense)).norm() <= 1e-12 * u.norm());
  }
}

TEST_CASE("the operator's error is the judge's, inside and outside the cones") {
  for (const FrictionProblem& problem : problems()) {
    ContactOperator op;
    op.prepare(problem);
    Impulses r = some_impulses(problem);
    Eigen::VectorXd u;
    for (int round = 0; round < 2; ++round) {
      op.velocity(r, u);
      CHECK(op.error(r, u) == Approx(contact_error(problem, r).natural_map_rms).epsilon(1e-10));
      op.project(r);
    }
    CHECK(contact_error(problem, r).cone_violation <= 1e-14);
    for (int c = 0; c < problem.contact_count(); ++c)
      if (op.rho()[c] == 0.0) CHECK(op.at(r, c).norm() == 0.0);
  }
}
