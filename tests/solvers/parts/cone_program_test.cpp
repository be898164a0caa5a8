#include "solvers/parts/cone_program.hpp"

#include "problems/algebra/contact_error.hpp"
#include "problems/algebra/known_solutions.hpp"
#include "tests/catch.hpp"
#include "tests/problems/algebra/dense_oracle.hpp"

using namespace ballast;

TEST_CASE("the program's units: blocks of largest eigenvalue one, q of largest entry one") {
  const FrictionProblem problem = oracle::mixed_problem();
  ConeProgram program;
  program.take(problem);
  CHECK(program.contact_count() == 6);  // one of the seven does not move
  CHECK(program.q.lpNorm<Eigen::Infinity>() == Approx(1.0));
  const Eigen::MatrixXd w(program.w);
  CHECK((w - w.transpose()).norm() == 0.0);
  for (int k = 0; k < program.contact_count(); ++k) {
    const int rows = program.row_begin[k + 1] - program.row_begin[k];
    CHECK(program.has_friction(k) == (rows == 3));
    const Eigen::MatrixXd block = w.block(program.row_begin[k], program.row_begin[k], rows, rows);
    CHECK(oracle::eigenvalues(block).maxCoeff() == Approx(1.0));
  }
}

TEST_CASE("a convex solver with the s-update around it comes to Coulomb's law") {
  const KnownSolution known = make_known_solution({.bodies = 20, .contacts = 15});
  ConeProgram program;
  program.take(known.problem);
  // Projected gradient until it converges: slow and simple.
  const auto convex = [&](const ConeRequest& request, RoundAnswer& answer) {
    Eigen::VectorXd x = request.start;
    for (int k = 0; k < 3000; ++k) {
      x -= 0.2 * (program.w * x + request.q);
      program.project(x);
    }
    answer.x = x;
  };
  const Solved solved = program.solve(Impulses::Zero(known.problem.row_count()),
                                      {.tolerance = 1e-6, .max_iterations = 60}, 20, convex);
  CHECK(solved.reason == StopReason::reached_tolerance);
  CHECK(contact_error(known.problem, solved.impulses).natural_map_rms <= 1e-6);
}
