// The command `ballast convert`.

#include "platform/hdf5_file.hpp"
#include "problems/algebra/contact_error.hpp"
#include "problems/algebra/known_solutions.hpp"
#include "problems/files/problem_file.hpp"
#include "tests/support/problem_folder.hpp"
#include "tests/support/program.hpp"
#include "tests/support/temporary_folder.hpp"

using namespace ballast;
namespace fs = std::filesystem;

TEST_CASE("a collection goes from format to format and stays the same problem") {
  const ProblemFolder c;
  for (const std::string to : {"local", "global", "both"}) {
    const auto target = c.out / to;
    const ProgramResult result =
        ballast_program({"convert", c.in.string(), "--to", to, "--output", target.string()});
    INFO(result.errors);
    REQUIRE(result.status == 0);
    const auto converted = find_problems(target.string());
    REQUIRE(converted.size() == 2);
    CHECK(converted[1].name.parent_path() == "deep");
    const FrictionProblem problem = read_problem(converted[0].file);
    CHECK(problem.has_dynamics == (to == "global" || to == "both"));
    // The known solution is valid, with three rows at every contact.
    CHECK(contact_error(problem, three_rows(c.known.problem, c.known.r)).natural_map_max < 1e-12);
  }
}

TEST_CASE("one problem becomes one file") {
  const ProblemFolder c;
  const std::string problem = (c.in / "a.hdf5").string();
  for (const std::string name : {"b.hdf5", "b.h5"}) {
    const fs::path target = c.out / "new" / name;
    const ProgramResult result = ballast_program({"convert", problem, "--output", target.string()});
    INFO(result.errors);
    REQUIRE(result.status == 0);
    REQUIRE(fs::is_regular_file(target));
    CHECK_FALSE(read_problem(target).has_dynamics);
  }
  const std::string file = (c.out / "c.hdf5").string();
  CHECK(ballast_program({"convert", problem, "--to", "global", "--output", file}).status == 0);
  CHECK(read_problem(file).has_dynamics);
  check_failure(ballast_program({"convert", problem, "--output", (c.out / "c.dat").string()}),
                ExitCode::usage, {"c.dat: only .hdf5 and .h5 are written"});
  check_failure(ballast_program({"convert", c.in.string(), "--output", file}), ExitCode::usage,
                {"c.hdf5: one file for 2 problems, expected a folder"});
  // The name of a folder may end in a suffix.
  fs::create_directories(c.out / "folder.dat");
  CHECK(ballast_program({"convert", c.in.string(), "--output", (c.out / "folder.dat").string()})
            .status == 0);
  CHECK(find_problems((c.out / "folder.dat").string()).size() == 2);
}

TEST_CASE("only what convert wrote is written over") {
  const ProblemFolder c;
  const fs::path target = c.out / "a.hdf5";
  const std::vector<std::string> words{"convert", (c.in / "a.hdf5").string(), "--output", target};
  REQUIRE(ballast_program(words).status == 0);
  CHECK(ballast_program(words).status == 0);
  const auto refuses = [&] {
    const auto before = fs::last_write_time(target);
    check_failure(ballast_program(words), ExitCode::failure,
                  {target.string() + ": is no problem of convert"});
    CHECK(fs::last_write_time(target) == before);
  };
  write_problem(target, c.known.problem, StoredForms::both,
                [](Hdf5Writer& file) { file.add_group("/ballast"); });
  refuses();
  write_solution(target, c.known.problem, {.r = c.known.r, .numbers = {}, .texts = {}});
  refuses();
}

TEST_CASE("what cannot be converted is said, and the others are") {
  const ProblemFolder c;
  c.folder.write("in/broken.dat", "3 x");
  check_failure(ballast_program({"convert", c.in.string(), "--output", c.out.string()}),
                ExitCode::failure, {"1 of 3 problems are not converted", "broken.dat: line 1"});
  CHECK(find_problems(c.out.string()).size() == 2);
  const fs::path local = c.out / "a.hdf5";
  check_failure(ballast_program({"convert", local.string(), "--to", "global", "--output",
                                 (c.out / "global").string()}),
                ExitCode::failure, {"a.hdf5: only W is known"});
  check_failure(ballast_program({"convert", c.in.string(), "--output", c.in.string()}),
                ExitCode::failure, {"written over what is read"});
  // Two problems of the same name would be one file.
  check_failure(ballast_program({"convert", (c.in / "a.hdf5").string(), (c.out / "a.hdf5").string(),
                                 "--output", (c.out / "both").string()}),
                ExitCode::failure, {"1 of 2 problems", "a.hdf5: holds"});
  check_failure(ballast_program({"convert", c.in.string(), "--to", "json", "--output", "x"}),
                ExitCode::usage, {"--to", "expected one of local, global, both"});
}
