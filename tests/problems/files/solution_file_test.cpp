#include "problems/files/solution_file.hpp"

#include "platform/hdf5_file.hpp"
#include "problems/algebra/known_solutions.hpp"
#include "problems/files/problem_file_error.hpp"
#include "tests/catch.hpp"
#include "tests/support/temporary_folder.hpp"

using namespace ballast;
using Catch::Contains;

TEST_CASE("An answer comes back with its bits, and its file holds what FCLIB reads") {
  const TemporaryFolder folder;
  const auto file = folder.path() / "answer.hdf5";
  const KnownSolution known = make_known_solution({.contacts = 20, .frictionless_fraction = 0.3});
  REQUIRE(known.problem.row_count() < 60);
  write_solution(file, known.problem, {known.r, {{"iterations", 7.0}}, {{"solver", "pgs"}}});
  CHECK(read_solution(file, known.problem) == known.r);
  const Hdf5Reader stored(file);
  CHECK(stored.shape("/solution/u")[0] == 60);
  CHECK(stored.shape("/solution/v")[0] ==
        static_cast<unsigned long long>(known.problem.dynamics.dof_count()));
  CHECK(stored.read_doubles("/ballast_answer/iterations")[0] == 7.0);
  CHECK(stored.read_text("/ballast_answer/solver") == "pgs");
}

TEST_CASE("Another problem's answer and a broken one are refused") {
  const TemporaryFolder folder;
  const auto file = folder.path() / "answer.hdf5";
  KnownSolution known = make_known_solution({.contacts = 20});
  write_solution(file, known.problem, {known.r, {}, {}});
  CHECK_THROWS_WITH(read_solution(file, make_known_solution({.contacts = 21}).problem),
                    Contains("/solution/r has 60 entries") && Contains("21 contacts have 63"));
  Hdf5Writer writer(file, Hdf5Storage::plain);
  writer.add_group("/solution");
  writer.add("/solution/r", std::vector<double>(60, std::nan("")));
  writer.commit();
  CHECK_THROWS_WITH(read_solution(file, known.problem), Contains("/solution/r[0] is not finite"));
  CHECK_THROWS_AS(read_solution(folder.write("x.hdf5", "text"), known.problem), ProblemFileError);
}
