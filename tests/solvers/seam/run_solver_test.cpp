#include "solvers/seam/run_solver.hpp"

#include <functional>
#include <limits>

#include "problems/algebra/known_solutions.hpp"
#include "solvers/backends/gauss_seidel.hpp"
#include "tests/catch.hpp"
#include "tests/problems/algebra/unsolvable.hpp"

using namespace ballast;

namespace {

/// Returns what it is told to, whatever the problem.
class Puppet final : public Solver {
 public:
  Solved answer;
  std::function<void()> on_prepare = [] {}, on_solve = [] {};
  int solved = 0;

  void prepare(const FrictionProblem&) override { on_prepare(); }
  Solved solve(const FrictionProblem&, Impulses given, const Budget&) override {
    ++solved;
    start = std::move(given);
    on_solve();
    return answer;
  }
  Impulses start;
};

const KnownSolution known = make_known_solution({});

}  // namespace

TEST_CASE("a claim is believed only when the judge agrees") {
  Puppet puppet;
  SolverRunner runner;
  puppet.answer = {known.r, StopReason::reached_tolerance, 1, 0.0, 0.0, {}};
  const SolverRun honest = runner.run(puppet, known.problem, {}, {});
  CHECK(honest.success);
  CHECK(honest.error.natural_map_rms < 1e-12);

  puppet.answer.impulses = 0.99 * known.r;  // own_residual still claims 0
  const SolverRun lie = runner.run(puppet, known.problem, {}, {});
  CHECK_FALSE(lie.success);
  CHECK(lie.error.natural_map_rms > 1e-4);

  puppet.answer = {known.r, StopReason::stalled, 1, 0.0, 0.0, {}};
  CHECK_FALSE(runner.run(puppet, known.problem, {}, {}).success);
}

TEST_CASE("a solver that stops on the natural map goes on until the law holds") {
  // With mu = 1e4 a natural map below the tolerance leaves the contact sinking in.
  const FrictionProblem problem = rough_contact(1e4);
  Puppet puppet;
  puppet.answer = {Impulses::Zero(3), StopReason::reached_tolerance, 5, 0.0, 0.0, {}};
  puppet.on_solve = [&] {
    if (puppet.solved == 2) puppet.answer.impulses = Eigen::Vector3d(9.81e-3, -1e-3, 0.0);
  };
  const SolverRun run = SolverRunner().run(puppet, problem, {}, {.tolerance = 1e-5});
  CHECK(puppet.solved == 2);
  CHECK(puppet.start == Impulses::Zero(3));
  CHECK(run.verdict == Verdict::solved);
  CHECK(run.solved.iterations == 10);
  // One that cannot do better is denied, and not asked for ever.
  puppet.answer.impulses.setZero(3);
  puppet.on_solve = [] {};
  puppet.solved = 0;
  CHECK(SolverRunner().run(puppet, problem, {}, {.tolerance = 1e-5}).verdict == Verdict::denied);
  CHECK(puppet.solved < 10);
  // The budget is one budget.
  puppet.solved = 0;
  SolverRunner().run(puppet, problem, {}, {.tolerance = 1e-5, .max_iterations = 5});
  CHECK(puppet.solved == 1);
}

TEST_CASE("an empty start means zero; a wrong one never reaches the solver") {
  Puppet puppet;
  SolverRunner runner;
  puppet.answer = {known.r, StopReason::reached_tolerance, 1, 0.0, 0.0, {}};
  runner.run(puppet, known.problem, {}, {});
  CHECK(puppet.start == Impulses::Zero(known.problem.row_count()));
  runner.run(puppet, known.problem, known.r, {});
  CHECK(puppet.start == known.r);
  const int before = puppet.solved;
  CHECK_THROWS_AS(runner.run(puppet, known.problem, Impulses::Zero(1), {}), InvalidProblem);
  Impulses bad = known.r;
  bad[3] = std::numeric_limits<double>::quiet_NaN();
  try {
    runner.run(puppet, known.problem, bad, {});
    FAIL("no exception");
  } catch (const InvalidProblem& error) {
    CHECK(std::string(error.what()).find("start[3]") == 0);
  }
  FrictionProblem broken = known.problem;
  broken.friction[0] = -1.0;
  CHECK_THROWS_AS(runner.run(puppet, broken, {}, {}), InvalidProblem);
  CHECK(puppet.solved == before);
}

TEST_CASE("a backend that throws, or returns rubbish, has failed; one that declines says so") {
  Puppet puppet;
  SolverRunner runner;
  puppet.on_solve = [] { throw std::runtime_error("singular"); };
  SolverRun run = runner.run(puppet, known.problem, {}, {});
  CHECK(run.solved.reason == StopReason::numerical_failure);
  CHECK(run.solved.impulses == Impulses::Zero(known.problem.row_count()));
  CHECK_FALSE(run.success);
  puppet.on_prepare = [] { throw std::bad_alloc(); };
  CHECK(runner.run(puppet, known.problem, {}, {}).solved.reason == StopReason::numerical_failure);
  puppet.on_prepare = [] { throw UnsupportedProblem("puppet: no"); };
  CHECK_THROWS_AS(runner.run(puppet, known.problem, {}, {}), UnsupportedProblem);

  puppet.on_prepare = puppet.on_solve = [] {};
  puppet.answer = {Impulses::Zero(2), StopReason::reached_tolerance, 1, 0.0, 0.0, {}};
  run = runner.run(puppet, known.problem, {}, {});
  CHECK(run.solved.reason == StopReason::numerical_failure);
  CHECK_FALSE(run.success);
  puppet.answer = {
      Impulses::Constant(known.problem.row_count(), std::numeric_limits<double>::quiet_NaN()),
      StopReason::reached_tolerance,
      1,
      0.0,
      0.0,
      {}};
  run = runner.run(puppet, known.problem, {}, {});
  CHECK_FALSE(run.error.finite);
  CHECK_FALSE(run.success);
}

TEST_CASE("one runner and one solver serve a sequence of problems") {
  const auto solver = make_gauss_seidel();
  SolverRunner runner;
  for (const int contacts : {30, 5, 60, 0, 30}) {
    KnownSolutionSettings settings;
    settings.bodies = 60;
    settings.contacts = contacts;
    settings.friction_max = 0.5;
    const FrictionProblem problem = make_known_solution(settings).problem;
    const SolverRun run = runner.run(*solver, problem, {}, {});
    CHECK(run.success);
    const auto fresh = make_gauss_seidel();
    CHECK(SolverRunner().run(*fresh, problem, {}, {}).solved.impulses ==
          run.solved.impulses);  // nothing left over
    CHECK(run.prepare_seconds >= 0.0);
    CHECK(run.solve_seconds > 0.0);
  }
}
