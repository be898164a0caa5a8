#include "solvers/backends/gauss_seidel.hpp"

#include <numeric>

#include "problems/algebra/contact_error.hpp"
#include "problems/algebra/known_solutions.hpp"
#include "solvers/gauss_seidel/body_sweep.hpp"
#include "solvers/gauss_seidel/delassus_sweep.hpp"
#include "solvers/seam/run_solver.hpp"
#include "tests/catch.hpp"
#include "tests/problems/algebra/dense_oracle.hpp"
#include "tests/support/delassus_form.hpp"
#include "tests/support/slow_sweep.hpp"

using namespace ballast;

namespace {

std::vector<int> order_of(const BodySweep&, const FrictionProblem& problem) {
  return plan_order(problem);
}
std::vector<int> order_of(const DelassusSweep&, const FrictionProblem& problem) {
  std::vector<int> order(problem.contact_count());
  std::iota(order.begin(), order.end(), 0);
  return order;
}

template <typename Sweep>
void check_sweeps(const FrictionProblem& given, const FrictionProblem& dense) {
  const Eigen::MatrixXd w = oracle::dense_delassus(dense);
  const Eigen::VectorXd q = oracle::dense_q(dense);
  Impulses slow = Impulses::Constant(given.row_count(), 0.1), fast = slow;
  Sweep sweep;
  sweep.prepare(given);
  sweep.load(given, fast);
  for (int k = 0; k < 10; ++k) {
    slow_sweep(dense, w, q, order_of(sweep, given), slow);
    sweep.sweep();
    sweep.store(given, fast);
    REQUIRE((fast - slow).norm() <= 1e-11 * (1.0 + slow.norm()));
    const double judged = contact_error(dense, fast).natural_map_rms;
    REQUIRE(sweep.error() == Approx(judged).epsilon(1e-6).margin(1e-13));
  }
}

std::vector<FrictionProblem> problems() {
  KnownSolutionSettings settings;
  settings.friction_max = 0.8;
  std::vector<FrictionProblem> all{make_known_solution(settings).problem, oracle::mixed_problem()};
  settings.mass_ratio = 100.0;
  settings.contacts = 100;
  all.push_back(make_known_solution(settings).problem);
  FrictionProblem diagonal = all[0];
  for (std::size_t k = 0; k < diagonal.dynamics.mass.size(); ++k)
    if (k % 36 % 7 != 0) diagonal.dynamics.mass[k] = 0.0;
  all.push_back(diagonal);
  return all;
}

}  // namespace

TEST_CASE("the sweep over bodies is the textbook's") {
  for (const FrictionProblem& problem : problems()) check_sweeps<BodySweep>(problem, problem);
}

TEST_CASE("the sweep over W is the textbook's") {
  for (const FrictionProblem& problem : problems()) {
    FrictionProblem stored = problem;
    add_delassus_form(stored);
    stored.has_dynamics = false;
    check_sweeps<DelassusSweep>(stored, problem);
  }
}

TEST_CASE("W and the bodies agree on an order with runs of both kinds of contact") {
  KnownSolutionSettings settings;
  settings.frictionless_fraction = 0.5;
  const FrictionProblem problem = make_known_solution(settings).problem;
  check_sweeps<BodySweep>(problem, problem);
}

TEST_CASE("impulses that are loaded come back") {
  const KnownSolution known = make_known_solution({});
  BodySweep sweep;
  sweep.prepare(known.problem);
  Impulses back = Impulses::Zero(known.r.size());
  sweep.load(known.problem, known.r);
  sweep.store(known.problem, back);
  CHECK((back - known.r).norm() <= 1e-14 * known.r.norm());
  CHECK(sweep.error() < 1e-12);
}

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
