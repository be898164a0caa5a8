// A solver that is a program: Ballast itself behind its own protocol, and programs that break it.

#include "experiments/external/external_program.hpp"

#include "problems/algebra/known_solutions.hpp"
#include "solvers/seam/run_solver.hpp"
#include "solvers/solver_list.hpp"
#include "tests/catch.hpp"
#include "tests/support/temporary_folder.hpp"

using namespace ballast;
using Catch::Contains;

namespace {

const ExternalLimits limits{.memory_MB = 0.0, .startup_seconds = 20.0};
const std::string own = std::string(BALLAST_PROGRAM) + " answer --solver pgs";

SolverRun solved_by(const ExternalCommand& command, double max_seconds = 20.0) {
  static const FrictionProblem problem =
      make_known_solution({.bodies = 6, .contacts = 12, .seed = 3}).problem;
  return SolverRunner().run(*external_solver(command, limits)(), problem, {},
                            {1e-8, 10000, max_seconds, true});
}

}  // namespace

TEST_CASE("Ballast behind its own protocol solves as it does here") {
  // Three rows at every contact, so that the file's problem is the one here.
  const FrictionProblem problem =
      make_known_solution({.bodies = 6, .contacts = 12, .frictionless_fraction = 0.0, .seed = 3})
          .problem;
  const Budget budget{1e-8, 10000, 20.0, true};
  const SolverRun here = SolverRunner().run(*make_solver("pgs"), problem, {}, budget);
  REQUIRE(here.is_solved());
  const bool is_served = GENERATE(false, true);
  const auto make = external_solver({"own", own, is_served, ""}, limits);
  // More than one problem for the same process.
  for (int repeat = 0; repeat < 2; ++repeat) {
    const SolverRun there = SolverRunner().run(*make(), problem, {}, budget);
    CHECK(there.is_solved());
    CHECK((there.solved.impulses - here.solved.impulses).cwiseAbs().maxCoeff() < 1e-7);
    CHECK(there.solved.history.size() == here.solved.history.size());
    CHECK(there.startup_seconds > 0.0);
    CHECK(there.solved.iterations > 0);
  }
}

TEST_CASE("A program that ends without an answer is lost, with its last words") {
  CHECK_THROWS_WITH(solved_by({"bad", "echo no licence >&2; exit 3 #", false, ""}),
                    Contains("bad: the program ended with exit code 3: no licence"));
  CHECK_THROWS_WITH(solved_by({"bad", "kill -SEGV $$ #", true, ""}), Contains("signal 11"));
  CHECK_THROWS_AS(solved_by({"bad", "no_such_program_here", false, ""}), LostProcess);
}

TEST_CASE("A program that does not answer is killed") {
  ExternalLimits short_limits = limits;
  short_limits.startup_seconds = 0.0;
  const FrictionProblem problem = make_known_solution({.bodies = 2, .contacts = 2}).problem;
  for (const bool is_served : {false, true}) {
    const auto make = external_solver({"late", "exec sleep 1000 #", is_served, ""}, short_limits);
    CHECK_THROWS_WITH(SolverRunner().run(*make(), problem, {}, {1e-8, 100, 0.01, false}),
                      Contains("late: killed: no answer within"));
  }
}

TEST_CASE("A served program that died or failed is asked again for the next problem") {
  const TemporaryFolder folder;
  // Dies in its first life, works in its second.
  const std::string mark = (folder.path() / "mark").string();
  const std::string command =
      "test -e " + mark + " || { touch " + mark + "; echo ready; read line; exit 9; }; exec " + own;
  const auto make = external_solver({"phoenix", command, true, ""}, limits);
  const FrictionProblem problem = make_known_solution({.bodies = 4, .contacts = 6}).problem;
  const Budget budget{1e-6, 10000, 20.0, false};
  CHECK_THROWS_WITH(SolverRunner().run(*make(), problem, {}, budget), Contains("exit code 9"));
  CHECK(SolverRunner().run(*make(), problem, {}, budget).is_solved());
}

TEST_CASE("A program that says it failed, or leaves no answer, is a failed solve") {
  const SolverRun none = solved_by({"none", "true", false, ""});
  CHECK_FALSE(none.is_solved());
  CHECK_THAT(none.failure, Contains("none: answer1.hdf5: no such file"));
  const std::string failing =
      "echo noise; echo ready; read line; echo noise; echo 'failed: too large'; read line #";
  CHECK_THAT(solved_by({"says", failing, true, ""}).failure, Contains("says: failed: too large"));
}
