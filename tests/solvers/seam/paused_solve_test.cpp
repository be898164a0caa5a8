#include "solvers/seam/paused_solve.hpp"

#include <stdexcept>
#include <string>
#include <vector>

#include "problems/algebra/pile_problems.hpp"
#include "solvers/backends/nesterov_pgs.hpp"
#include "solvers/backends/newton.hpp"
#include "solvers/backends/newton_burst.hpp"
#include "tests/catch.hpp"

using namespace ballast;

namespace {

FrictionProblem slow_pile() {
  return make_pile(
      {.contacts = 40, .redundancy = 0.5, .mass_ratio = 1e4, .slenderness = 8.0, .seed = 2});
}

const PausedSolve::Pause never = [](int, double) { return false; };

/// Looks at an error that halves with each of its iterations, until it is asked to leave.
struct Counter final : Solver {
  int looks = 0;
  bool was_sent_away = false, throws = false;
  void prepare(const FrictionProblem&) override {}
  Solved solve(const FrictionProblem&, Impulses r, const Budget& budget) override {
    Solved solved;
    double error = 1.0;
    while (!was_sent_away && looks < budget.max_iterations) {
      ++looks;
      if (throws && looks == 3) throw std::runtime_error("no third look");
      r[0] = looks;
      was_sent_away = (*budget.leave)(looks, error *= 0.5, r);
    }
    solved.impulses = std::move(r);
    solved.iterations = looks;
    solved.history = {{looks, 0.0, error}};
    return solved;
  }
};

}  // namespace

TEST_CASE("a solve that pauses at every look ends with the bits of one that never pauses") {
  const FrictionProblem problem = slow_pile();
  const Budget budget{.tolerance = 1e-9, .max_iterations = 4000};
  const Impulses start = Impulses::Zero(problem.row_count());
  const auto check = [&](std::unique_ptr<Solver> solver) {
    solver->prepare(problem);
    const Solved whole = solver->solve(problem, start, budget);
    PausedSolve paused(*solver, problem, start, budget);
    int turns = 0, iterations = 0;
    Solved last;
    while (!paused.is_over()) {
      last = paused.go_on([&](int, double) { return true; });
      iterations += last.iterations;
      ++turns;
    }
    CHECK(turns > 10);
    CHECK(last.impulses == whole.impulses);
    CHECK(last.reason == whole.reason);
    CHECK(iterations == whole.iterations);
  };
  check(make_nesterov_pgs());
  check(make_newton_burst({.start_sweeps = 0, .burst = 20}));
  check(make_newton({}));
}

TEST_CASE("a pause tells what came since the last one") {
  Counter counter;
  PausedSolve paused(counter, {}, Impulses::Zero(1), {.max_iterations = 10});
  CHECK(counter.looks == 0);
  const Solved first = paused.go_on([](int iterations, double) { return iterations == 3; });
  CHECK(counter.looks == 3);
  CHECK(first.iterations == 3);
  CHECK(first.impulses[0] == 3.0);
  CHECK(first.reason == StopReason::stalled);
  CHECK(first.own_residual == 0.125);
  const Solved second = paused.go_on([](int iterations, double) { return iterations == 2; });
  CHECK(second.iterations == 2);
  REQUIRE(second.history.size() == 2);
  CHECK(second.history[0].iteration == 1);
  CHECK(second.history[1].error == 1.0 / 32.0);
  CHECK_FALSE(paused.is_over());
  const Solved rest = paused.go_on(never);
  CHECK(paused.is_over());
  CHECK(rest.iterations == 5);
  CHECK(rest.history.size() == 5);
  CHECK(rest.impulses[0] == 10.0);
}

TEST_CASE("a paused solve that is no longer wanted is sent away, at once or where it stands") {
  Counter never_begun, begun;
  { PausedSolve paused(never_begun, {}, Impulses::Zero(1), {}); }
  CHECK(never_begun.looks == 0);
  {
    PausedSolve paused(begun, {}, Impulses::Zero(1), {});
    paused.go_on([](int, double) { return true; });
  }
  CHECK(begun.looks == 1);
  CHECK(begun.was_sent_away);
}

TEST_CASE("what a paused solve throws reaches whoever lets it go on") {
  Counter counter;
  counter.throws = true;
  PausedSolve paused(counter, {}, Impulses::Zero(1), {});
  CHECK_NOTHROW(paused.go_on([](int, double) { return true; }));
  CHECK_THROWS_WITH(paused.go_on(never), "no third look");
}
