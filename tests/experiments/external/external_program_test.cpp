// Solvers that are programs: Ballast itself behind its own protocol, and programs that break it.

#include "experiments/external/external_program.hpp"

#include <limits>

#include "platform/atomic_file.hpp"
#include "platform/error.hpp"
#include "platform/hdf5_file.hpp"
#include "problems/algebra/contact_error.hpp"
#include "problems/algebra/known_solutions.hpp"
#include "problems/files/problem_file.hpp"
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
  // With three rows at every contact the problem in the file is the problem here.
  const FrictionProblem problem =
      make_known_solution({.bodies = 6, .contacts = 12, .frictionless_fraction = 0.0, .seed = 3})
          .problem;
  const Budget budget{1e-8, 10000, 20.0, true};
  const SolverRun here = SolverRunner().run(*make_solver("pgs"), problem, {}, budget);
  REQUIRE(here.is_solved());
  const bool is_served = GENERATE(false, true);
  const auto make = external_solver({"own", own, is_served, ""}, limits);
  // Solves two problems, which a served program takes in one process.
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
  // This program dies in its first life and works in its second.
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

TEST_CASE("Programs are named on the command line and in lists") {
  const TemporaryFolder folder;
  const auto list = folder.write("list.toml",
                                 "[[external]]\nname = \"a\"\ncommand = \"a.py --fast=1\"\n"
                                 "[[external]]\nname = \"b\"\ncommand = \"b\"\nserve = true\n");
  const auto commands = external_commands({"c=python3 'x y.py' k=v", list.string()});
  REQUIRE(commands.size() == 3);
  CHECK(commands[0].name == "c");
  CHECK(commands[0].command == "python3 'x y.py' k=v");
  CHECK(commands[0].folder.empty());
  CHECK(commands[1].command == "a.py --fast=1");
  CHECK_FALSE(commands[1].is_served);
  CHECK(commands[1].folder == folder.path());
  CHECK(commands[2].is_served);
}

TEST_CASE("What is wrong with the words is said") {
  const TemporaryFolder folder;
  const std::string empty = folder.write("empty.toml", "").string();
  const std::pair<std::vector<std::string>, const char*> wrongs[] = {
      {{"solver"}, "expected name=command"},
      {{"x= "}, "x: expected a command"},
      {{"a/b=x"}, "a name has letters"},
      {{"a=x", "a=y"}, "a: this name is there twice"},
      {{empty}, "has no [[external]]"}};
  for (const auto& [words, refusal] : wrongs)
    CHECK_THROWS_WITH(external_commands(words), Contains(refusal));
  const auto typo =
      folder.write("typo.toml", "[[external]]\nname = \"a\"\ncommand = \"b\"\nserved = true\n");
  CHECK_THROWS_AS(external_commands({typo}), Error);
}

TEST_CASE("An edited script has another key") {
  const TemporaryFolder folder;
  const auto script = folder.write("solver.py", "1");
  const ExternalCommand command{"a", "python3 '" + script.string() + "'", false, ""};
  const std::string before = key_of(command);
  CHECK(key_of(command) == before);
  folder.write("solver.py", "2");
  CHECK(key_of(command) != before);
}

namespace {

struct Asked {
  TemporaryFolder folder;
  KnownSolution known =
      make_known_solution({.bodies = 5, .contacts = 12, .frictionless_fraction = 0.3});
  ExternalRequest request{.problem = known.problem,
                          .start = known.r,
                          .tolerance = 1e-6,
                          .fclib_tolerance = 0.0,
                          .max_iterations = 77,
                          .max_seconds = std::numeric_limits<double>::infinity(),
                          .id = 5};
  ExternalAnswer answer{.status = 0,
                        .solved = {.impulses = known.r,
                                   .iterations = 3,
                                   .own_residual = 1e-7,
                                   .history = {{0, 0.0, 1.0}, {3, 0.25, 1e-7}}},
                        .seconds = 0.25};
  std::filesystem::path file = folder.path() / "file.hdf5";

  std::string refusal() const {
    try {
      read_answer(file, request);
    } catch (const Error& error) {
      return error.what();
    }
    return "taken";
  }
};

}  // namespace

TEST_CASE("A request comes back as the same problem, in both forms") {
  const Asked a;
  REQUIRE(a.known.problem.row_count() < 3 * a.known.problem.contact_count());
  write_request(a.file, a.request);
  const ExternalRequest read = read_request(a.file);
  CHECK(read.tolerance == a.request.tolerance);
  CHECK(read.max_iterations == 77);
  CHECK(read.max_seconds == a.request.max_seconds);
  CHECK(read.id == 5);
  CHECK(read.problem.has_dynamics);
  CHECK(contact_error(read.problem, read.start).natural_map_max < 1e-12);
  {  // W, for programs that do not use M and H
    const Hdf5Reader file(a.file);
    CHECK(file.has("/fclib_global/H"));
    CHECK(file.shape("/fclib_local/vectors/q")[0] == 36);
  }
  // Where only W is known, programs that read bodies get W too.
  Asked stored;
  stored.request.problem = condensed(a.known.problem);
  stored.request.start = three_rows(a.known.problem, a.known.r);
  write_request(stored.file, stored.request);
  CHECK_FALSE(read_request(stored.file).problem.has_dynamics);
}

TEST_CASE("An answer comes back with the rows of the problem") {
  const Asked a;
  write_answer(a.file, a.request, a.answer);
  const ExternalAnswer read = read_answer(a.file, a.request);
  CHECK(read.status == 0);
  CHECK(read.solved.impulses == a.answer.solved.impulses);
  CHECK(read.solved.iterations == 3);
  CHECK(read.solved.own_residual == 1e-7);
  CHECK(read.seconds == 0.25);
  REQUIRE(read.solved.history.size() == 2);
  CHECK(read.solved.history[1].error == 1e-7);
}

TEST_CASE("Optional numbers that say nothing cost no answer") {
  Asked a;
  a.answer.solved.own_residual = a.answer.seconds = std::nan("");
  a.answer.solved.iterations = std::numeric_limits<int>::max();
  a.answer.solved.history.insert(a.answer.solved.history.begin(),
                                 {{0, 0.0, std::nan("")}, {1, HUGE_VAL, 1.0}});
  write_answer(a.file, a.request, a.answer);
  const ExternalAnswer read = read_answer(a.file, a.request);
  CHECK(read.solved.impulses == a.answer.solved.impulses);
  CHECK(read.solved.own_residual == 0.0);
  CHECK(read.seconds == -1.0);
  CHECK(read.solved.iterations == 77);
  REQUIRE(read.solved.history.size() == 2);
  CHECK(read.solved.history[0].error == 1.0);
}

TEST_CASE("What is no answer is refused with the reason") {
  Asked a;
  CHECK_THAT(a.refusal(), Contains("no such file"));
  SECTION("NaN") {
    a.answer.solved.impulses[4] = std::nan("");
    write_answer(a.file, a.request, a.answer);
    CHECK_THAT(a.refusal(), Contains("/ballast_answer/r[") && Contains("not finite"));
  }
  SECTION("another status") {
    a.answer.status = 7;
    write_answer(a.file, a.request, a.answer);
    CHECK_THAT(a.refusal(), Contains("status = 7, expected 0 to 6"));
  }
  SECTION("a status that is no number") {
    Hdf5Writer file(a.file, Hdf5Storage::plain);
    file.add_group("/ballast_answer");
    file.add("/ballast_answer/protocol", std::vector<int>{1});
    file.add("/ballast_answer/id", std::vector<int>{5});
    file.add("/ballast_answer/status", std::vector<double>{std::nan("")});
    file.commit();
    CHECK_THAT(a.refusal(), Contains("status = nan, expected 0 to 6"));
  }
  SECTION("another problem's") {
    ExternalRequest other = a.request;
    other.id = 4;
    write_answer(a.file, other, a.answer);
    CHECK_THAT(a.refusal(), Contains("answers another problem"));
  }
  SECTION("another problem's with this number") {
    ExternalRequest other = a.request;
    other.problem = make_known_solution({.bodies = 3, .contacts = 4}).problem;
    a.answer.solved.impulses.setZero(other.problem.row_count());
    write_answer(a.file, other, a.answer);
    CHECK_THAT(a.refusal(), Contains("12 entries, must have 36"));
  }
  SECTION("a history that lies on its side") {
    Hdf5Writer file(a.file, Hdf5Storage::plain);
    file.add_group("/ballast_answer");
    file.add("/ballast_answer/protocol", std::vector<int>{1});
    file.add("/ballast_answer/id", std::vector<int>{5});
    file.add("/ballast_answer/status", std::vector<int>{0});
    file.add("/ballast_answer/r", std::vector<double>(36));
    file.add("/ballast_answer/history", std::vector<double>(6), {3, 2});
    file.commit();
    CHECK_THAT(a.refusal(), Contains("history is 3 x 2, must be points x 3"));
  }
  SECTION("half a file") {
    write_answer(a.file, a.request, a.answer);
    std::filesystem::resize_file(a.file, std::filesystem::file_size(a.file) / 2);
    CHECK_THAT(a.refusal(), Contains("truncated"));
  }
  SECTION("another version") {
    Hdf5Writer file(a.file, Hdf5Storage::plain);
    file.add_group("/ballast_answer");
    file.add("/ballast_answer/protocol", std::vector<int>{2});
    file.commit();
    CHECK_THAT(a.refusal(), Contains("protocol = 2") && Contains("speaks 1"));
  }
  SECTION("a request") {
    write_request(a.file, a.request);
    CHECK_THAT(a.refusal(), Contains("/ballast_answer/protocol: no such dataset"));
  }
}

TEST_CASE("Who cannot solve needs no impulses") {
  Asked a;
  a.answer.status = ExternalAnswer::unsupported;
  a.answer.solved.impulses.resize(0);
  write_answer(a.file, a.request, a.answer);
  CHECK(read_answer(a.file, a.request).status == ExternalAnswer::unsupported);
  a.answer.status = 0;
  write_answer(a.file, a.request, a.answer);
  CHECK_THAT(a.refusal(), Contains("/ballast_answer/r: no such dataset"));
}

TEST_CASE("A stored problem is no request") {
  const Asked a;
  write_problem(a.file, a.known.problem);
  CHECK_THROWS_WITH(read_request(a.file), Contains("is no request"));
}
