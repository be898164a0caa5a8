#include "solvers/backends/gauss_seidel.hpp"

#include "problems/algebra/known_solutions.hpp"
#include "solvers/seam/run_solver.hpp"
#include "tests/catch.hpp"

using namespace ballast;

TEST_CASE("a warm start keeps the storage of the start") {
  const KnownSolution known = make_known_solution({});
  const auto solver = make_gauss_seidel();
  solver->prepare(known.problem);
  Impulses start = known.r;
  const double* storage = start.data();
  const Solved solved = solver->solve(known.problem, std::move(start), {});
  CHECK(solved.impulses.data() == storage);
}

TEST_CASE("a NaN that slipped past validation is a numerical failure, not an answer") {
  KnownSolution known = make_known_solution({});
  known.problem.dynamics.v_free[0] = std::nan("");
  const auto solver = make_gauss_seidel();
  solver->prepare(known.problem);
  const Solved solved = solver->solve(known.problem, Impulses::Zero(known.problem.row_count()), {});
  CHECK(solved.reason == StopReason::numerical_failure);
}

TEST_CASE("the settings decide when the error is looked at") {
  const KnownSolution known = make_known_solution({});
  const Budget budget{.tolerance = 0.0, .max_iterations = 20, .keep_history = true};
  const auto solver = make_gauss_seidel({.first_check = 5, .check_growth = 2.0});
  solver->prepare(known.problem);
  const Solved solved =
      solver->solve(known.problem, Impulses::Zero(known.problem.row_count()), budget);
  std::vector<int> looked;
  for (const HistoryPoint& point : solved.history) looked.push_back(point.iteration);
  CHECK(looked == std::vector<int>{0, 5, 10, 20});
}
