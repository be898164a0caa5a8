#include "solvers/seam/relay.hpp"

#include <algorithm>
#include <limits>
#include <thread>

#include "problems/algebra/known_solutions.hpp"
#include "solvers/backends/gauss_seidel.hpp"
#include "tests/catch.hpp"

using namespace ballast;

namespace {

constexpr double not_a_number = std::numeric_limits<double>::quiet_NaN();

/// A leg of so many iterations that ends with an impulse and an error.
Relay::Leg leg(int iterations, double impulse, double error,
               StopReason reason = StopReason::iteration_limit) {
  return [=](Impulses start, const Budget&) {
    Solved solved;
    solved.impulses = Impulses::Constant(start.size(), impulse);
    solved.reason = reason;
    solved.iterations = iterations;
    solved.own_residual = 7.0 * error;
    solved.history = {{0, 0.0, 1.0}, {iterations, 1e-3, error}};
    return solved;
  };
}

}  // namespace

TEST_CASE("what is left of a budget is never less than nothing, and the rest of it stays") {
  const Budget whole{
      .tolerance = 1e-3, .max_iterations = 10, .max_seconds = 2.0, .keep_history = true};
  const Budget rest = rest_of(whole, 4, 0.5);
  CHECK(rest.max_iterations == 6);
  CHECK(rest.max_seconds == 1.5);
  CHECK(rest.tolerance == 1e-3);
  CHECK(rest.keep_history);
  CHECK(rest_of(whole, 11, 3.0).max_iterations == 0);
  CHECK(rest_of(whole, 11, 3.0).max_seconds == 0.0);
}

TEST_CASE("what reached another measure is the answer, though its error is not the smallest") {
  Relay relay({.tolerance = 0.0, .max_iterations = 100}, Impulses::Zero(1));
  relay.run(leg(30, 1.0, 0.5));
  relay.run(leg(20, 2.0, 0.9, StopReason::reached_tolerance));
  CHECK(relay.over());
  const Solved solved = relay.finish();
  CHECK(solved.reason == StopReason::reached_tolerance);
  CHECK(solved.impulses == Impulses::Constant(1, 2.0));
}

TEST_CASE("every leg begins at the best iterate, and has what the others left") {
  Relay relay({.tolerance = 0.0, .max_iterations = 100}, Impulses::Constant(3, 5.0));
  CHECK_FALSE(relay.over());
  CHECK(relay.run(leg(30, 1.0, 0.5)) == 0.5);
  CHECK(relay.run(leg(20, 2.0, 0.9)) == 0.5);  // worse: not kept
  relay.run([](Impulses start, const Budget& left) {
    CHECK(start == Impulses::Constant(3, 1.0));
    CHECK(left.max_iterations == 50);
    CHECK(left.keep_history);
    CHECK(left.max_seconds <= 1e30);
    return leg(10, 3.0, 0.25)(start, left);
  });
  CHECK(relay.iterations() == 60);
  CHECK(relay.error() == 0.25);
  CHECK_FALSE(relay.over());
  const Solved solved = relay.finish();
  CHECK(solved.impulses == Impulses::Constant(3, 3.0));
  CHECK(solved.reason == StopReason::stalled);
  CHECK(solved.iterations == 60);
  CHECK(solved.own_residual == 7.0 * 0.25);
  CHECK(solved.history.empty());  // not asked for
}

TEST_CASE("the history counts on, without the points where a leg takes over") {
  Relay relay({.max_iterations = 100, .keep_history = true}, Impulses::Zero(1));
  relay.run(leg(30, 1.0, 0.5));
  std::this_thread::sleep_for(std::chrono::milliseconds(5));
  relay.run(leg(20, 2.0, 0.9));
  relay.run(leg(10, 3.0, 0.25));
  const Solved solved = relay.finish();
  std::vector<int> iterations;
  std::vector<double> errors;
  for (const HistoryPoint& point : solved.history) {
    iterations.push_back(point.iteration);
    errors.push_back(point.error);
  }
  CHECK(iterations == std::vector<int>{0, 30, 50, 60});
  CHECK(errors == std::vector<double>{1.0, 0.5, 0.5, 0.25});  // of the iterate that is kept
  CHECK(solved.history[2].seconds >= solved.history[1].seconds + 4e-3);
}

TEST_CASE("a leg that improves in no iterations is in the history, a worse one is not") {
  for (const double error : {0.25, 0.75}) {
    Relay relay({.max_iterations = 100, .keep_history = true}, Impulses::Zero(1));
    relay.run(leg(30, 1.0, 0.5));
    relay.run(leg(0, 2.0, error));
    relay.run(leg(10, 3.0, 0.125));
    const Solved solved = relay.finish();
    REQUIRE(solved.history.size() == 3);
    CHECK(solved.history[1].iteration == 30);
    CHECK(solved.history[1].error == std::min(error, 0.5));  // of the iterate that is kept
    CHECK(solved.history[2].iteration == 40);
    CHECK(solved.history[2].error == 0.125);
  }
}

TEST_CASE("a relay ends with the tolerance, a failure, or a limit, and says which") {
  const Budget budget{.max_iterations = 100};
  Relay reached(budget, Impulses::Zero(1));
  reached.run(leg(3, 1.0, 1e-9, StopReason::reached_tolerance));
  CHECK(reached.over());
  CHECK(reached.finish().reason == StopReason::reached_tolerance);

  Relay failed(budget, Impulses::Zero(1));
  failed.run(leg(3, 1.0, not_a_number, StopReason::numerical_failure));
  CHECK(failed.over());

  Relay counted(budget, Impulses::Zero(1));
  counted.run(leg(100, 1.0, 0.5));
  CHECK(counted.over());
  CHECK(counted.finish().reason == StopReason::iteration_limit);

  Relay late({.max_iterations = 100, .max_seconds = 1e-9}, Impulses::Zero(1));
  std::this_thread::sleep_for(std::chrono::milliseconds(1));
  CHECK(late.over());
  CHECK(late.finish().reason == StopReason::time_limit);
}

TEST_CASE("two legs of plain Gauss-Seidel end where one of both lengths does") {
  const FrictionProblem problem = make_known_solution({.bodies = 10, .contacts = 8}).problem;
  const auto solver = make_gauss_seidel();
  solver->prepare(problem);
  const Solved whole = solver->solve(problem, Impulses::Zero(problem.row_count()),
                                     {.tolerance = 0.0, .max_iterations = 30});
  Relay relay({.tolerance = 0.0, .max_iterations = 30}, Impulses::Zero(problem.row_count()));
  relay.run(*solver, problem, 10);
  CHECK(relay.iterations() == 10);
  relay.run(*solver, problem, 1000);
  const Solved relayed = relay.finish();
  CHECK(relayed.iterations == 30);
  CHECK((relayed.impulses - whole.impulses).norm() <= 1e-12 * whole.impulses.norm());
}
