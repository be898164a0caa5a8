#include "problems/algebra/made_problems.hpp"
#include "solvers/backends/backends.hpp"
#include "tests/catch.hpp"
#include "tests/support/solved.hpp"

using namespace ballast;

namespace {

/// Heavy on light bodies, with more contacts than the unknowns determine: slow for sweeps.
FrictionProblem heavy_pile(std::uint64_t seed, bool is_stored) {
  return make_pile({.contacts = 40,
                    .redundancy = 0.5,
                    .mass_ratio = 1e4,
                    .slenderness = 8.0,
                    .is_stored = is_stored,
                    .seed = seed});
}

}  // namespace

TEST_CASE("where sweeps arrive, auto is sweeps with momentum, bit for bit", "[factors]") {
  for (const bool is_stored : {false, true}) {
    const FrictionProblem problem =
        make_pile({.contacts = 300, .redundancy = 0.2, .is_stored = is_stored, .seed = 4});
    const Budget budget{.tolerance = 1e-5, .max_iterations = 10000};
    const SolverRun by_sweeps =
        judged_by(make_nesterov_pgs(/*returns_best=*/false), problem, budget);
    const SolverRun run = judged_by(make_auto(), problem, budget);
    REQUIRE(by_sweeps.is_solved());
    CHECK(run.is_solved());
    CHECK(run.solved.iterations == by_sweeps.solved.iterations);
    CHECK(run.solved.impulses == by_sweeps.solved.impulses);
  }
}

TEST_CASE("where no contact closes, auto has nothing to solve", "[factors]") {
  for (const bool is_stored : {false, true}) {
    FrictionProblem problem = make_pile({.contacts = 60, .is_stored = is_stored, .seed = 4});
    Eigen::VectorXd& rest = is_stored ? problem.delassus.q : problem.dynamics.bias;
    for (int c = 0; c < problem.contact_count(); ++c) rest[problem.row_begin[c]] += 1e3;
    const SolverRun open = judged_by(make_auto(), problem, {.tolerance = 1e-12});
    CHECK(open.is_solved());
    CHECK(open.solved.iterations == 0);
    CHECK(open.solved.impulses.isZero(0.0));
    rest[problem.row_begin[40]] -= 2e3;  // makes one contact push
    const SolverRun closed = judged_by(make_auto(), problem, {.tolerance = 1e-9});
    CHECK(closed.is_solved());
    CHECK(closed.solved.impulses.norm() > 0.0);
  }
}

TEST_CASE("where iterations are scarce, sweeps leave them to Newton while there are enough",
          "[factors]") {
  const Budget scarce{.tolerance = 1e-7, .max_iterations = 300};
  int by_sweeps = 0, by_auto = 0;
  for (const bool is_stored : {false, true})
    for (std::uint64_t seed = 1; seed <= 5; ++seed) {
      const FrictionProblem problem = heavy_pile(seed, is_stored);
      const SolverRun run = judged_by(make_auto(), problem, scarce);
      CHECK(run.solved.iterations <= scarce.max_iterations);
      by_auto += run.is_solved();
      by_sweeps += judged_by(make_nesterov_pgs(), problem, scarce).is_solved();
    }
  CHECK(by_auto == 10);
  CHECK(by_sweeps < 5);
}

TEST_CASE("of thousands of iterations sweeps that crawl leave enough to Newton", "[factors]") {
  const Budget thousands{.tolerance = 1e-7, .max_iterations = 10000};
  const FrictionProblem pile =
      make_pile({.contacts = 1500, .redundancy = 0.8, .mass_ratio = 1000.0, .seed = 3});
  CHECK_FALSE(judged_by(make_nesterov_pgs(), pile, thousands).is_solved());
  CHECK(judged_by(make_auto(), pile, thousands).is_solved());
}

TEST_CASE("what Newton does not solve is solved by turns", "[factors]") {
  int lost = 0;
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    const FrictionProblem problem = make_pile(random_pile(seed, 60));
    CAPTURE(seed);
    const Budget budget{.tolerance = 1e-8 * velocity_scale(problem),
                        .max_iterations = 1 << 30,
                        .max_seconds = 20.0};
    CHECK(judged_by(make_auto(), problem, budget).is_solved());
    lost += !judged_by(make_newton(ContactEquation::alart_curnier), problem, budget).is_solved();
  }
  CHECK(lost > 0);
}

TEST_CASE("work is counted, not clocked: the same bits every time", "[factors]") {
  const FrictionProblem problem = heavy_pile(7, true);
  const Budget budget{.tolerance = 1e-9, .max_iterations = 20000};
  const SolverRun first = judged_by(make_auto(), problem, budget),
                  second = judged_by(make_auto(), problem, budget);
  CHECK(first.is_solved());
  CHECK(first.solved.iterations == second.solved.iterations);
  CHECK(first.solved.impulses == second.solved.impulses);
}

TEST_CASE("sweeps that stand still get the time of eight Newton steps near the aim alone") {
  constexpr double step = 1000.0, all = 1e9;
  const Budget budget{.tolerance = 1e-6};
  const auto ends_at = [&](double error, double at_most) {
    const auto slow = sweep_stop_rule(step, at_most, budget);
    int sweeps = 100;
    while (!slow(sweeps, error)) sweeps += 100;
    return sweeps;
  };
  CHECK(ends_at(1e-3, all) == 500);
  CHECK(ends_at(1e-5, all) == 8000);
  CHECK(ends_at(1e-5, 600.0) == 600);
}

TEST_CASE("what nothing can reach ends as stalled", "[factors]") {
  const SolverRun run =
      judged_by(make_auto(), heavy_pile(2, true),
                {.tolerance = 0.0, .max_iterations = 1 << 30, .max_seconds = 60.0});
  CHECK(run.solved.reason == StopReason::stalled);
  CHECK(run.error.natural_map_rms < 1e-10);
}
