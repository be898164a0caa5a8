#include "solvers/seam/run_solver.hpp"

#include <functional>
#include <limits>

#include "problems/algebra/known_solutions.hpp"
#include "solvers/solver_list.hpp"
#include "tests/catch.hpp"
#include "tests/problems/algebra/unsolvable.hpp"

using namespace ballast;

namespace {

/// Returns a given answer, whatever the problem.
class Puppet final : public Solver {
 public:
  Solved answer;
  std::function<void()> on_prepare = [] {}, on_solve = [] {};
  int solved = 0;

  void says(const Impulses& r, StopReason reason = StopReason::reached_tolerance) {
    answer.impulses = r;
    answer.reason = reason;
    answer.iterations = 5;
  }
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

constexpr StopReason claimed = StopReason::reached_tolerance;

/// The judge's result for impulses that a solver returned for this reason, to 1e-8 m/s.
SolverRun judged(const FrictionProblem& problem, const Impulses& r, StopReason reason = claimed) {
  SolverRun run;
  run.solved.impulses = r;
  run.solved.reason = reason;
  run.error = contact_error(problem, r);
  run.verdict = verdict_of(reason, run.error, 1e-8);
  return run;
}

}  // namespace

TEST_CASE("a claim is believed only when the judge agrees") {
  Puppet puppet;
  SolverRunner runner;
  puppet.says(known.r);
  const SolverRun honest = runner.run(puppet, known.problem, {}, {});
  CHECK(honest.is_solved());
  CHECK(honest.error.natural_map_rms < 1e-12);

  puppet.says(0.99 * known.r);  // own_residual still claims 0
  const SolverRun lie = runner.run(puppet, known.problem, {}, {});
  CHECK_FALSE(lie.is_solved());
  CHECK(lie.error.natural_map_rms > 1e-4);

  puppet.says(known.r, StopReason::stalled);
  CHECK_FALSE(runner.run(puppet, known.problem, {}, {}).is_solved());
}

TEST_CASE("a solver that stops on the natural map goes on until the law holds") {
  // With mu = 1e4 the natural map is below the tolerance although the contact sinks in.
  const FrictionProblem problem = rough_contact(1e4);
  Puppet puppet;
  puppet.says(Impulses::Zero(3));
  puppet.on_solve = [&] {
    if (puppet.solved == 2) puppet.says(Eigen::Vector3d(9.81e-3, -1e-3, 0.0));
  };
  const SolverRun run = SolverRunner().run(puppet, problem, {}, {.tolerance = 1e-5});
  CHECK(puppet.solved == 2);
  CHECK(puppet.start == Impulses::Zero(3));
  CHECK(run.verdict == Verdict::solved);
  CHECK(run.solved.iterations == 10);
  // A solver that cannot do better is denied, and not called endlessly.
  puppet.says(Impulses::Zero(3));
  puppet.on_solve = [] {};
  puppet.solved = 0;
  CHECK(SolverRunner().run(puppet, problem, {}, {.tolerance = 1e-5}).verdict == Verdict::denied);
  CHECK(puppet.solved < 10);
  // All calls together have one budget.
  puppet.solved = 0;
  SolverRun ended =
      SolverRunner().run(puppet, problem, {}, {.tolerance = 1e-5, .max_iterations = 5});
  CHECK(puppet.solved == 1);
  CHECK(ended.solved.reason == StopReason::iteration_limit);
  CHECK(ended.verdict == Verdict::unsolved);
  ended = SolverRunner().run(puppet, problem, {}, {.tolerance = 1e-5, .max_seconds = 0.0});
  CHECK(ended.solved.reason == StopReason::time_limit);
  CHECK(ended.verdict == Verdict::unsolved);
}

TEST_CASE("a later round that fails or is worse leaves the answer before it") {
  const FrictionProblem problem = rough_contact(1e4);
  const Impulses first = Eigen::Vector3d(1e-7, 0.0, 0.0);  // denied, as zero impulses are
  Puppet puppet;
  SolverRunner runner;
  for (const bool throws : {true, false}) {
    puppet.says(first);
    puppet.solved = 0;
    puppet.on_solve = [&] {
      if (puppet.solved < 2) return;
      if (throws) throw std::runtime_error("singular");
      puppet.says(Eigen::Vector3d(1e3, 0.0, 0.0), StopReason::iteration_limit);
    };
    const SolverRun run = runner.run(puppet, problem, {}, {.tolerance = 1e-5});
    CHECK(puppet.solved == 2);
    CHECK(run.solved.impulses == first);
    CHECK(run.verdict == Verdict::unsolved);
    CHECK(run.error.natural_map_rms == contact_error(problem, first).natural_map_rms);
  }
}

TEST_CASE("an empty start means zero, a wrong one never reaches the solver") {
  Puppet puppet;
  SolverRunner runner;
  puppet.says(known.r);
  runner.run(puppet, known.problem, {}, {});
  CHECK(puppet.start == Impulses::Zero(known.problem.row_count()));
  runner.run(puppet, known.problem, known.r, {});
  CHECK(puppet.start == known.r);
  const int before = puppet.solved;
  CHECK_THROWS_AS(runner.run(puppet, known.problem, Impulses::Zero(1), {}), InvalidProblem);
  Impulses bad = known.r;
  bad[3] = std::numeric_limits<double>::quiet_NaN();
  CHECK_THROWS_WITH(runner.run(puppet, known.problem, bad, {}), "start[3] = nan is not finite");
  bad[3] = -1e31;
  CHECK_THROWS_WITH(runner.run(puppet, known.problem, bad, {}),
                    "start[3] = -1e+31 is beyond 1e+30");
  FrictionProblem broken = known.problem;
  broken.friction[0] = -1.0;
  CHECK_THROWS_AS(runner.run(puppet, broken, {}, {}), InvalidProblem);
  CHECK(puppet.solved == before);
}

TEST_CASE("a backend that throws, or returns rubbish, has failed, one that declines says so") {
  Puppet puppet;
  SolverRunner runner;
  puppet.on_solve = [] { throw std::runtime_error("singular"); };
  SolverRun run = runner.run(puppet, known.problem, {}, {});
  CHECK(run.solved.reason == StopReason::numerical_failure);
  CHECK(run.solved.impulses == Impulses::Zero(known.problem.row_count()));
  CHECK_FALSE(run.is_solved());
  puppet.on_prepare = [] { throw std::bad_alloc(); };
  CHECK(runner.run(puppet, known.problem, {}, {}).solved.reason == StopReason::numerical_failure);
  puppet.on_prepare = [] { throw UnsupportedProblem("puppet: no"); };
  CHECK_THROWS_AS(runner.run(puppet, known.problem, {}, {}), UnsupportedProblem);

  puppet.on_prepare = puppet.on_solve = [] {};
  puppet.says(Impulses::Zero(2));
  run = runner.run(puppet, known.problem, {}, {});
  CHECK(run.solved.reason == StopReason::numerical_failure);
  CHECK_FALSE(run.is_solved());
  puppet.says(Impulses::Constant(known.problem.row_count(), std::nan("")));
  run = runner.run(puppet, known.problem, {}, {});
  CHECK_FALSE(run.error.finite);
  CHECK_FALSE(run.is_solved());
}

TEST_CASE("one runner and one solver serve a sequence of problems") {
  for (const char* name : {"pgs", "nesterov_pgs", "nncg"}) {
    CAPTURE(name);
    const auto solver = make_solver(name);
    SolverRunner runner;
    for (const int contacts : {30, 5, 60, 0, 30}) {
      const FrictionProblem problem =
          make_known_solution({.bodies = 60, .contacts = contacts, .friction_max = 0.5}).problem;
      const SolverRun run = runner.run(*solver, problem, {}, {});
      CHECK(run.is_solved());
      CHECK(SolverRunner().run(*make_solver(name), problem, {}, {}).solved.impulses ==
            run.solved.impulses);  // nothing is left over from earlier problems
      CHECK(run.prepare_seconds >= 0.0);
      CHECK(run.solve_seconds > 0.0);
    }
  }
}

TEST_CASE("a contact that no impulse moves and that sinks in has no solution") {
  const Impulses none = Impulses::Zero(3);
  CHECK(judged(immovable_contact(-1.0), none).verdict == Verdict::no_solution);
  CHECK(judged(immovable_contact(1.0), none).verdict == Verdict::solved);
  CHECK(judged(immovable_contact(-1.0), none, StopReason::stalled).verdict == Verdict::no_solution);
  // An impulse where u_N > 0 is not a solution.
  CHECK(judged(immovable_contact(1.0), Eigen::Vector3d(2.0, 0.0, 0.0)).verdict == Verdict::denied);
}

TEST_CASE("impulses that swallow the velocities solve nothing") {
  Impulses r = Impulses::Zero(6);
  r[0] = r[3] = 1e17;  // r - rho u == r: the natural map is zero
  SolverRun run = judged(squeezed_contacts(), r);
  CHECK(run.error.natural_map_rms <= 1e-8);
  CHECK(run.error.min_normal_velocity == -1.0);
  CHECK(run.verdict == Verdict::no_solution);
  CHECK(run.error.fclib < 1e-8);
  CHECK(verdict_of(claimed, run.error, 1e-8, /*by_fclib=*/true) == Verdict::no_solution);
  run.solved.impulses.setZero(3);  // of a problem for which nothing is proved
  CHECK(explained(rough_contact(0.5), run, 1e-8) ==
        "no solution found; r grows without bound: 1e+17 times what a contact alone needs");
  r[0] = r[3] = 1e3;  // not yet so large
  CHECK(judged(squeezed_contacts(), r).verdict == Verdict::denied);
  CHECK(judged(squeezed_contacts(), r, StopReason::iteration_limit).verdict == Verdict::unsolved);
}

TEST_CASE("what stops a heavy body that touches light ones is no growth") {
  // 1 kg at 1 m/s against a body of 1e-9 kg that lies on the floor: r_N = 1, 1 + 1e-9.
  FrictionProblem problem;
  problem.has_dynamics = true;
  DynamicsForm& d = problem.dynamics;
  const Eigen::Matrix3d one = Eigen::Matrix3d::Identity();
  d.add_body(one);
  d.add_body(1e-9 * one);
  problem.add_contact(0, 1, 0.5, one, -one);
  problem.add_contact(-1, 1, 0.5, {}, one);
  d.v_free = Eigen::VectorXd::Zero(6);
  d.v_free[0] = d.v_free[3] = -1.0;
  d.bias = Eigen::VectorXd::Zero(6);
  const Impulses r = Impulses::Unit(6, 0) + (1.0 + 1e-9) * Impulses::Unit(6, 3);
  SolverRun run = judged(problem, r);
  CHECK(run.error.growth == Approx(1.0));
  CHECK(run.verdict != Verdict::no_solution);
  explained(problem, run, 1e-8);
  CHECK(run.verdict != Verdict::no_solution);
  CHECK(verdict_of(claimed, run.error, 1e-6) == Verdict::solved);
}

TEST_CASE("impulses that a start brought along have not grown") {
  const FrictionProblem problem = rough_contact(0.5);
  const Impulses large = 1e9 * Impulses::Unit(3, 0);
  Puppet puppet;
  puppet.says(large, StopReason::iteration_limit);
  CHECK(SolverRunner().run(puppet, problem, large, {}).verdict == Verdict::unsolved);
  CHECK(SolverRunner().run(puppet, problem, {}, {}).verdict == Verdict::no_solution);
}

TEST_CASE("with much friction a small natural map is not enough") {
  // With no impulse at all the contact sinks in, and mu |u_T| hides it.
  SolverRun falls = judged(rough_contact(1e9), Impulses::Zero(3));
  CHECK(falls.error.natural_map_rms < 1e-10);
  CHECK(falls.error.approach_rms == Approx(9.81e-3));
  CHECK(falls.verdict == Verdict::denied);
  CHECK(explained(rough_contact(1e9), falls, 1e-8) ==
        "the judge denies it: -u_N is 0.00981 m/s (rms), at most 4e-08 may be");
  // A contact at rest is solved.
  SolverRun stands = judged(rough_contact(1e4), Eigen::Vector3d(9.81e-3, -1e-3, 0.0));
  CHECK(stands.is_solved());
  CHECK(explained(rough_contact(1e4), stands, 1e-8) == "solved");
}

TEST_CASE("what is not solved says why, and is searched for a proof that it cannot be") {
  const FrictionProblem problem = rough_contact(0.5);
  SolverRun run = judged(problem, Impulses::Zero(3));
  CHECK_THAT(explained(problem, run, 1e-8), Catch::Contains("the natural map is"));
  run.error.finite = false;
  CHECK(verdict_of(claimed, run.error, 1e300) == Verdict::denied);
  CHECK(verdict_of(claimed, run.error, 0.0) == Verdict::unsolved);  // no tolerance was asked for
  CHECK(explained(problem, run, 1e300) ==
        "the judge denies it: the impulses, or velocities that they give, are not finite");
  SolverRun early = judged(problem, Impulses::Zero(3), StopReason::time_limit);
  CHECK(explained(problem, early, 1e-8) == "unsolved: time_limit");
  early.failure = "why";
  CHECK(explained(problem, early, 1e-8) == "unsolved: time_limit: why");
  CHECK(early.verdict == Verdict::unsolved);
  SolverRun none = judged(squeezed_contacts(), Impulses::Zero(6), StopReason::stalled);
  none.prepare_seconds = 2.0;  // the whole time limit
  CHECK(explained(squeezed_contacts(), none, 1e-8, 2.0) == "unsolved: stalled");
  CHECK(explained(squeezed_contacts(), none, 1e-8) ==
        "there is no solution: 2 contacts (one is 0) sink in at 1 m/s in the mean whatever the "
        "impulses");
  CHECK(none.verdict == Verdict::no_solution);
}
