#include <algorithm>
#include <cmath>
#include <vector>

#include "problems/algebra/contact_error.hpp"
#include "problems/algebra/known_solutions.hpp"
#include "problems/algebra/made_problems.hpp"
#include "solvers/backends/backends.hpp"
#include "solvers/gauss_seidel/any_sweep.hpp"
#include "tests/catch.hpp"
#include "tests/support/delassus_form.hpp"
#include "tests/support/slow_sweep.hpp"
#include "tests/support/solved.hpp"

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
  CHECK(from_rest(*make_gauss_seidel(), known.problem, {}).reason == StopReason::numerical_failure);
}

TEST_CASE("a start whose error is not finite comes back as it was, not as memory was") {
  const FrictionProblem stored = only_delassus(make_known_solution({}).problem);
  const auto solver = make_nesterov_pgs();
  solver->prepare(stored);
  const Impulses ones = Impulses::Ones(stored.row_count());
  const Solved solved = solver->solve(stored, 1e300 * ones, {.max_iterations = 0});
  CHECK((1e-300 * solved.impulses).isApprox(ones));
}

namespace {

FrictionProblem slender_pile(int contacts) {
  return make_pile({.contacts = contacts, .active = 1.0, .slenderness = 20.0, .seed = 3});
}

/// The last iterate after this number of iterations from no impulses, even if it is not the best.
Impulses after(const FrictionProblem& problem, int iterations) {
  return from_rest(*make_nesterov_pgs(/*returns_best=*/false), problem,
                   {.tolerance = 0.0, .max_iterations = iterations})
      .impulses;
}

/// The same by the formula: stores whole iterates and all squares, and starts each sweep from x +
/// beta (x - x before).
Impulses by_the_book(const FrictionProblem& problem, int iterations, int& restarts, int& limited) {
  AnySweep sweep;
  sweep.prepare(problem);
  Impulses x = Impulses::Zero(problem.row_count()), before = x, from = x;
  std::vector<double> squares;  // since the search began
  for (int k = 0, vain = 0, rest = 0; k < iterations; ++k) {
    sweep->load(problem, from);
    sweep->sweep();
    before = x;
    sweep->store(problem, x);
    squares.push_back(swept_square(problem, x - from));
    const double now = squares.back(), least = *std::min_element(squares.begin(), squares.end());
    const int j = static_cast<int>(squares.size()) - 1;
    const bool circles = rest == 0 && now > 1.3 * least;
    if (circles) {
      vain = j < 6 ? vain + 1 : 0;
      rest = vain == 3 ? 33 : 0;
      if (rest > 0) vain = 0;
      ++restarts;
    }
    if (rest > 0) --rest;
    if (circles || rest > 0 || j == 0) {
      squares = {now};
      from = x;
      continue;
    }
    const int sweeps = j >= 8 ? 8 : j >= 4 ? 4 : j >= 2 ? 2 : 1;
    const double factor = std::pow(now / squares[j - sweeps], 1.0 / sweeps);
    limited += factor < j / (j + 2.0);
    from = x + std::min(j / (j + 2.0), factor) * (x - before);
  }
  return x;
}

}  // namespace

TEST_CASE("nesterov_pgs: its iterates are those of the formula, over bodies and over W") {
  const FrictionProblem problem = make_known_solution({.bodies = 40, .contacts = 120}).problem;
  for (const FrictionProblem& form : {problem, only_delassus(problem)}) {
    int restarts = 0, limited = 0;
    for (const int iterations : {1, 2, 3, 7, 25, 120}) {
      const Impulses expected = by_the_book(form, iterations, restarts, limited);
      CHECK((after(form, iterations) - expected).norm() <= 1e-11 * expected.norm());
    }
    CHECK(restarts > 0);  // both rules were applied
    CHECK(limited > 0);
  }
}

TEST_CASE("nesterov_pgs: a chain of bodies takes less than half of the sweeps without momentum") {
  const FrictionProblem problem = slender_pile(1500);
  const auto iterations = [&](Solver& solver) {
    const Solved solved = from_rest(solver, problem, {.tolerance = 1e-6});
    CHECK(solved.reason == StopReason::reached_tolerance);
    CHECK(contact_error(problem, solved.impulses).natural_map_rms <= 1e-6);
    return solved.iterations;
  };
  CHECK(2 * iterations(*make_nesterov_pgs()) < iterations(*make_gauss_seidel()));
}

TEST_CASE("nesterov_pgs: where momentum goes round without end, plain sweeps come through") {
  // Without rests 20,000 sweeps were not enough; plain sweeps need 12,900.
  const FrictionProblem problem = make_pile(random_pile(59, 300));
  const Budget budget{.tolerance = 1e-5 * velocity_scale(problem), .max_iterations = 20000};
  const Solved solved = from_rest(*make_nesterov_pgs(), problem, budget);
  CHECK(solved.reason == StopReason::reached_tolerance);
  CHECK(contact_error(problem, solved.impulses).natural_map_rms <= budget.tolerance);
}

TEST_CASE(
    "nesterov_pgs: where the last iterate is a worse one, the best that was seen comes back") {
  const FrictionProblem pile = make_pile(random_pile(59, 300)), stored = only_delassus(pile);
  for (const FrictionProblem* problem : {&pile, &stored}) {
    for (int iterations = 20; iterations < 400; iterations += 7) {
      const Budget budget{.tolerance = 0.0, .max_iterations = iterations, .keep_history = true};
      const Solved solved = from_rest(*make_nesterov_pgs(), *problem, budget);
      double least = solved.history.front().error;
      for (const HistoryPoint& point : solved.history) least = std::min(least, point.error);
      CAPTURE(problem == &pile, iterations);
      CHECK(solved.own_residual <= 1.05 * least);  // one plain sweep follows the best iterate
      CHECK(solved.history.back().error == solved.own_residual);
      CHECK(contact_error(*problem, solved.impulses).natural_map_rms ==
            Approx(solved.own_residual).epsilon(1e-6));
    }
  }
}

TEST_CASE("nesterov_pgs: a stored W that a few sweeps answer is looked at after a few") {
  const FrictionProblem problem = make_pile({.contacts = 10, .is_stored = true, .seed = 2});
  const Budget budget{.tolerance = 1e-4 * velocity_scale(problem), .keep_history = true};
  const Solved solved = from_rest(*make_nesterov_pgs(), problem, budget);
  CHECK(solved.reason == StopReason::reached_tolerance);
  CHECK(solved.iterations < 8);       // the first check by schedule
  CHECK(solved.history.size() <= 3);  // at rest, and at most one check too early
}
