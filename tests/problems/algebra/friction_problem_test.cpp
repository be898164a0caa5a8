#include "problems/algebra/friction_problem.hpp"

#include "problems/algebra/known_solutions.hpp"
#include "tests/catch.hpp"
#include "tests/problems/algebra/dense_oracle.hpp"

using namespace ballast;

namespace {

Eigen::VectorXd some_impulses(int rows) { return Eigen::VectorXd::LinSpaced(rows, -1.0, 2.0); }

}  // namespace

TEST_CASE("velocities agree with dense matrices") {
  KnownSolutionSettings settings;
  const FrictionProblem problems[] = {oracle::mixed_problem(),
                                      make_known_solution(settings).problem};
  for (const FrictionProblem& problem : problems) {
    const Impulses r = some_impulses(problem.row_count());
    const Eigen::MatrixXd h = oracle::dense_h(problem), mass = oracle::dense_mass(problem);
    Eigen::VectorXd q, u, v, p;
    free_contact_velocity(problem, q);
    CHECK((q - oracle::dense_q(problem)).norm() < 1e-12 * q.norm());
    contact_velocity(problem, r, u);
    const Eigen::VectorXd expected = oracle::dense_delassus(problem) * r + oracle::dense_q(problem);
    CHECK((u - expected).norm() < 1e-12 * expected.norm());
    body_velocity(problem.dynamics, problem.row_begin, r, v);
    CHECK((mass * (v - problem.dynamics.v_free) - h.transpose() * r).norm() < 1e-12 * r.norm());
    contact_to_body_impulse(problem.dynamics, problem.row_begin, r, p);
    CHECK((p - h.transpose() * r).norm() < 1e-13 * r.norm());
    CHECK((Eigen::MatrixXd(sparse_mass(problem.dynamics)) - mass).norm() == 0.0);
    CHECK((Eigen::MatrixXd(sparse_h(problem)) - h).norm() == 0.0);
  }
}

TEST_CASE("velocities from the stored Delassus form") {
  FrictionProblem problem = oracle::mixed_problem();
  problem.has_delassus = true;
  problem.delassus.w = oracle::dense_delassus(problem).sparseView();
  problem.delassus.q = oracle::dense_q(problem);
  Eigen::VectorXd with_dynamics, without;
  const Impulses r = some_impulses(problem.row_count());
  contact_velocity(problem, r, with_dynamics);
  problem.has_dynamics = false;
  contact_velocity(problem, r, without);
  CHECK((with_dynamics - without).norm() < 1e-12 * without.norm());
  Eigen::VectorXd q;
  free_contact_velocity(problem, q);
  CHECK(q == problem.delassus.q);
}

TEST_CASE("impulses of the wrong size are refused") {
  const FrictionProblem problem = oracle::mixed_problem();
  Eigen::VectorXd u;
  CHECK_THROWS_AS(contact_velocity(problem, Impulses::Zero(problem.row_count() + 1), u),
                  InvalidProblem);
  CHECK_THROWS_AS(body_velocity(problem.dynamics, problem.row_begin, Impulses::Zero(2), u),
                  InvalidProblem);
}

TEST_CASE("a cleared problem is empty and keeps its storage") {
  FrictionProblem problem = oracle::mixed_problem();
  const double* h = problem.dynamics.h.data();
  const std::size_t capacity = problem.dynamics.h.capacity();
  problem.clear();
  CHECK(problem.contact_count() == 0);
  CHECK(problem.row_count() == 0);
  CHECK(problem.dynamics.body_count() == 0);
  CHECK(problem.dynamics.dof_count() == 0);
  CHECK_FALSE(problem.has_dynamics);
  CHECK_NOTHROW(problem.validate());
  CHECK(problem.dynamics.h.capacity() == capacity);
  CHECK(problem.dynamics.h.data() == h);
}
