#include "solvers/backends/step_work.hpp"

#include "problems/algebra/known_solutions.hpp"
#include "problems/algebra/pile_problems.hpp"
#include "solvers/backends/newton.hpp"
#include "solvers/seam/solver.hpp"
#include "tests/catch.hpp"

using namespace ballast;

TEST_CASE("over bodies a Newton step costs what the fill of its factorisation says, told once",
          "[factors]") {
  // Bodies that touch at random fill the factors: counting bodies does not tell.
  const FrictionProblem graph = make_known_solution({.bodies = 400, .contacts = 1000}).problem;
  StepWork work;
  work.count(graph);
  const double by_sizes = work.burst_step();
  CHECK_FALSE(work.learn(0.0));
  const auto newton = make_newton({});
  newton->prepare(graph);
  CHECK(work.learn(newton->operations()));
  CHECK(work.burst_step() > 3.0 * by_sizes);
  CHECK_FALSE(work.learn(1.0));
  CHECK(work.newton_step() > work.burst_step());
  work.count(graph);
  CHECK(work.burst_step() == by_sizes);
}

TEST_CASE("with a stored W a factorisation costs what the pressed contacts make of it",
          "[factors]") {
  FrictionProblem pile = make_pile({.contacts = 30, .is_stored = true, .seed = 1});
  const auto newton = make_newton({});
  newton->prepare(pile);
  CHECK(newton->operations() == 0.0);
  const auto operations = [&] {
    newton->solve(pile, Impulses::Zero(pile.row_count()), {.max_iterations = 1});
    return newton->operations();
  };
  // Everything opens: nothing is factored. Everything is pressed: all 90 rows are.
  pile.delassus.q.setZero();
  for (int c = 0; c < pile.contact_count(); ++c) pile.delassus.q[pile.row_begin[c]] = 1.0;
  CHECK(operations() == 0.0);
  for (int c = 0; c < pile.contact_count(); ++c) pile.delassus.q[pile.row_begin[c]] = -1.0;
  CHECK(operations() == 90.0 * 90.0 * 90.0 / 3.0);
  StepWork work;
  work.count(pile);
  CHECK_FALSE(work.learn(newton->operations()));
  CHECK(work.stored_step(newton->operations()) > 2.0 * work.newton_step());
}

TEST_CASE("mixed sweeps wait over bodies, unless a factorisation is dear", "[factors]") {
  StepWork work;
  work.count(make_pile({.contacts = 30, .seed = 1}));
  CHECK(work.mixed_after() == 2.0);
  CHECK(work.mixed_sweep() > 2.0 * work.sweep());
  work.count(make_pile({.contacts = 30, .is_stored = true, .seed = 1}));
  CHECK(work.mixed_after() == 0.5);
  CHECK(work.mixed_sweep() < 2.0 * work.sweep());
}
