// The answers that `ballast solve` stores and starts from.

#include "problems/algebra/contact_error.hpp"
#include "problems/algebra/known_solutions.hpp"
#include "problems/files/problem_file.hpp"
#include "solvers/seam/run_solver.hpp"
#include "solvers/solver_list.hpp"
#include "tests/support/problem_folder.hpp"
#include "tests/support/program.hpp"
#include "tests/support/temporary_folder.hpp"

using namespace ballast;
namespace fs = std::filesystem;

TEST_CASE("the program's answer has the bits of the library's") {
  const ProblemFolder c;
  const std::string problem = (c.in / "a.hdf5").string();
  const fs::path answer = c.folder.path() / "answer.hdf5";
  const FrictionProblem read = read_problem(problem);
  const double scale = contact_error(read, Impulses::Zero(read.row_count())).velocity_scale;
  for (const char* name : {"pgs", "nncg", "newton_ac", "auto"}) {
    INFO(name);
    REQUIRE(
        ballast_program({"solve", problem, "--solver", name, "--output", answer.string()}).status ==
        0);
    const auto solver = make_solver(name);
    const SolverRun run = SolverRunner().run(*solver, read, {}, {1e-8 * scale, 10000});
    CHECK(read_solution(answer, read) == run.solved.impulses);
  }
}

TEST_CASE("solve keeps its answer and starts from it") {
  const ProblemFolder c;
  const std::string problem = (c.in / "a.hdf5").string();
  const fs::path answer = c.folder.path() / "answer.hdf5";
  const ProgramResult first = ballast_program({"solve", problem, "--output", answer.string()});
  INFO(first.errors);
  REQUIRE(first.status == 0);
  const FrictionProblem read = read_problem(problem);
  CHECK(contact_error(read, read_solution(answer, read)).natural_map_rms < 1e-7);
  // The start is a solution: no iteration is needed.
  const ProgramResult again =
      ballast_program({"solve", problem, "--start", answer.string(), "--json"});
  CHECK_THAT(again.output, Catch::Contains("\"iterations\": 0"));
  // The answers of several problems are put into a folder.
  const std::vector<std::string> both = {"solve", problem, (c.in / "deep" / "b.hdf5").string(),
                                         "--output"};
  std::vector<std::string> words = both;
  words.push_back(c.out.string());
  REQUIRE(ballast_program(words).status == 0);
  CHECK(fs::exists(c.out / "b.hdf5"));
  words.back() = answer.string();
  check_failure(ballast_program(words), ExitCode::usage, {"several problems need a folder"});
  check_failure(ballast_program({"solve", problem, "--start", problem}), ExitCode::failure,
                {"/solution/r: no such dataset (no_start)"});
  const std::string none = (c.in / "none.hdf5").string();
  check_failure(ballast_program({"solve", problem, "--start", none}), ExitCode::failure,
                {"none.hdf5: no such file (no_start)"});
}

TEST_CASE("a file's name that is no UTF-8 is shown as far as it is") {
  const ProblemFolder c;
  const fs::path odd = c.folder.path() / "caf\xe9.hdf5";
  fs::copy_file(c.in / "a.hdf5", odd);
  const ProgramResult result = ballast_program({"solve", odd.string(), "--json"});
  INFO(result.errors);
  CHECK_THAT(result.output, Catch::Contains("\"verdict\": "));
}

TEST_CASE("solve replaces nothing but an older answer") {
  const ProblemFolder c;
  const std::string a = (c.in / "a.hdf5").string(), b = (c.in / "deep" / "b.hdf5").string(),
                    text = c.folder.write("min.toml", "").string();
  fs::create_directories(c.out);
  fs::copy_file(a, c.out / "a.hdf5");
  const auto fails = [&](std::vector<std::string> words, const char* named) {
    words.insert(words.begin(), {"solve", a});
    const ProgramResult result = ballast_program(words);
    check_failure(result, ExitCode::failure, {named});
    CHECK_FALSE(Catch::Contains("unreadable").match(result.errors + result.output));
  };
  fails({"--output", a}, "a.hdf5: is no answer of Ballast: it would be written over");
  fails({"--output", b}, "b.hdf5: is no answer");
  fails({"--output", text}, "min.toml: cannot make the folder");
  fails({(c.out / "a.hdf5").string(), "--output", (c.folder.path() / "new").string()},
        "a.hdf5: holds the answer to");
  CHECK(read_problem(b).contact_count() == 12);
}
