#include "solvers/gauss_seidel/sweep_variant.hpp"

#include <algorithm>

#include "problems/algebra/known_solutions.hpp"
#include "solvers/gauss_seidel/body_sweep.hpp"
#include "solvers/gauss_seidel/delassus_sweep.hpp"
#include "tests/catch.hpp"
#include "tests/problems/algebra/dense_oracle.hpp"
#include "tests/support/delassus_form.hpp"
#include "tests/support/slow_sweep.hpp"

using namespace ballast;

namespace {

std::vector<FrictionProblem> problems() {
  return {make_known_solution({.contacts = 60}).problem, oracle::mixed_problem()};
}

/// The plain sweep's own order.
std::vector<int> order_of(const BodySweep&, const FrictionProblem& problem) {
  return plan_order(problem);
}
std::vector<int> order_of(const DelassusSweep&, const FrictionProblem& problem) {
  return in_order(problem);
}

/// Three sweeps by `variant` against three plain ones.
template <typename Sweep>
void check_same_as_plain(const FrictionProblem& problem, const SweepVariant& variant,
                         double accuracy) {
  Sweep plain, other;
  Impulses start = Impulses::Constant(problem.row_count(), 0.1), fast = start, slow = start;
  plain.prepare(problem);
  other.prepare(problem);
  plain.load(problem, start);
  other.load(problem, start);
  for (int k = 0; k < 3; ++k) {
    plain.sweep();
    other.sweep(variant, order_of(other, problem));
  }
  plain.store(problem, fast);
  other.store(problem, slow);
  CHECK((fast - slow).norm() <= accuracy * fast.norm());
  CHECK(plain.error() == Approx(other.error()).epsilon(1e-6).margin(1e-13));
}

}  // namespace

TEST_CASE(
    "the slow loop with the plain settings is the plain sweep, and Newton finds what the exact "
    "solution is") {
  for (const FrictionProblem& problem : problems()) {
    FrictionProblem stored = problem;
    add_delassus_form(stored);
    for (const LocalRule rule : {LocalRule::exact, LocalRule::newton}) {
      check_same_as_plain<BodySweep>(problem, {.rule = rule}, 1e-9);
      check_same_as_plain<DelassusSweep>(stored, {.rule = rule}, 1e-9);
    }
  }
}

TEST_CASE("a solution is what no variant leaves") {
  const KnownSolution known = make_known_solution({.bodies = 20, .contacts = 15});
  BodySweep sweep;
  sweep.prepare(known.problem);
  for (const SweepVariant variant :
       {SweepVariant{.rule = LocalRule::projection}, SweepVariant{.rule = LocalRule::newton},
        SweepVariant{.relaxation = 1.3}, SweepVariant{.relaxation = 0.5}}) {
    sweep.load(known.problem, known.r);
    sweep.sweep(variant, in_order(known.problem));
    Impulses r = known.r;
    sweep.store(known.problem, r);
    CHECK((r - known.r).norm() <= 1e-9 * known.r.norm());
  }
}

TEST_CASE(
    "orders: every contact once, backward after forward, shuffled the same for the same seed") {
  ContactOrder order, again;
  order.begin({.order = SweepOrder::symmetric}, 5);
  CHECK(order.next() == std::vector<int>{0, 1, 2, 3, 4});
  CHECK(order.next() == std::vector<int>{4, 3, 2, 1, 0});
  CHECK(order.next() == std::vector<int>{0, 1, 2, 3, 4});

  const SweepVariant random{.order = SweepOrder::random, .seed = 3};
  order.begin(random, 50);
  again.begin(random, 50);
  const std::vector<int> first = order.next();
  CHECK(first == again.next());
  const std::vector<int> second = order.next();
  CHECK(second != first);
  std::vector<int> sorted = second;
  std::sort(sorted.begin(), sorted.end());
  for (int c = 0; c < 50; ++c) CHECK(sorted[c] == c);
}
