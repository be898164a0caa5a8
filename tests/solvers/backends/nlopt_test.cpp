// Solves the one-contact problem by a general optimiser, an oracle for the exact local solution.

#include "platform/random.hpp"
#include "solvers/parts/one_contact.hpp"
#include "solvers/solver_list.hpp"
#include "tests/catch.hpp"
#include "tests/support/delassus_form.hpp"
#include "tests/support/solved.hpp"

using namespace ballast;

TEST_CASE("nlopt and the exact solution of one contact agree") {
  const SolverEntry& entry = find_solver("nlopt_slsqp");
  if (!entry.make) return;  // built without NLopt
  Random random(5);
  int solved = 0, pushed = 0;
  for (int trial = 0; trial < 200; ++trial) {
    Eigen::Matrix3d root;
    for (double& entry_of_root : root.reshaped()) entry_of_root = random.uniform(-1, 1);
    const Eigen::Matrix3d w = root * root.transpose() + 0.2 * Eigen::Matrix3d::Identity();
    const Eigen::Vector3d q(random.uniform(-1, 0.3), random.uniform(-1, 1), random.uniform(-1, 1));
    const double mu = random.uniform(0.0, 0.6);  // small enough for a unique solution
    CAPTURE(trial, mu);

    Eigen::Vector3d exact;
    double lambda = 0.0;
    solve_one_contact(w, q, mu, exact, lambda);
    const SolverRun run = judged_by(entry.make(), stored_problem({mu}, w, q), {.tolerance = 1e-9});
    if (!run.is_solved()) continue;  // it may stall, but must not be wrong
    ++solved;
    pushed += exact[0] > 0.0;
    CHECK((run.solved.impulses - exact).norm() < 1e-7 * (1.0 + exact.norm()));
  }
  CHECK(solved > 180);
  CHECK(pushed > 100);
}
