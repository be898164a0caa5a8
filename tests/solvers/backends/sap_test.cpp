#include "problems/algebra/known_solutions.hpp"
#include "solvers/backends/backends.hpp"
#include "tests/catch.hpp"
#include "tests/support/delassus_form.hpp"
#include "tests/support/solved.hpp"

using namespace ballast;

namespace {

FrictionProblem rank_deficient() {
  return make_known_solution({.bodies = 20, .contacts = 40}).problem;
}

}  // namespace

TEST_CASE(
    "proximal steps take the regularisation away: the convex law is met, Coulomb's is not "
    "claimed",
    "[factors]") {
  const FrictionProblem problem = rank_deficient();
  const SolverRun run = judged_by(make_sap(), problem, {.tolerance = 1e-8, .max_iterations = 2000});
  CHECK(run.solved.reason == StopReason::stalled);
  CHECK(run.solved.own_residual <= 1e-8);
  CHECK(run.error.natural_map_rms > 1e-3);
}

TEST_CASE("sap finds the same velocities where only W is known", "[factors]") {
  const FrictionProblem problem = rank_deficient();
  const FrictionProblem stored = only_delassus(problem);
  const Budget budget{.tolerance = 1e-8, .max_iterations = 2000};
  const SolverRun bodies = judged_by(make_sap(), problem, budget);
  const SolverRun matrix = judged_by(make_sap(), stored, budget);
  CHECK(matrix.solved.own_residual <= 1e-8);
  Eigen::VectorXd of_bodies, of_matrix;
  contact_velocity(problem, bodies.solved.impulses, of_bodies);
  contact_velocity(problem, matrix.solved.impulses, of_matrix);
  CHECK((of_bodies - of_matrix).norm() <= 1e-6 * of_bodies.norm());
}

TEST_CASE("sap names what it cannot take", "[factors]") {
  FrictionProblem stored = only_delassus(rank_deficient());
  stored.delassus.w.coeffRef(0, 1) += 0.1 * stored.delassus.w.coeff(0, 0);
  CHECK_THROWS_WITH(make_sap()->prepare(stored), Catch::Contains("not symmetric"));
}
