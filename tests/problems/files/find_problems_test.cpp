#include "platform/error.hpp"
#include "problems/files/problem_file.hpp"
#include "tests/catch.hpp"
#include "tests/support/temporary_folder.hpp"

using namespace ballast;
namespace fs = std::filesystem;

TEST_CASE("A word names a file, a folder or a pattern") {
  const TemporaryFolder folder;
  fs::create_directories(folder.path() / "in" / "deep");
  for (const char* name : {"in/b.dat", "in/a.hdf5", "in/deep/c.h5", "in/notes.txt"})
    folder.write(name, "");
  const std::string top = folder.path().string();
  const auto all = find_problems(top + "/in");
  REQUIRE(all.size() == 3);
  CHECK(all[0].name == "a.hdf5");
  CHECK(all[2].name == "deep/c.h5");
  CHECK(all[2].file == folder.path() / "in/deep/c.h5");
  CHECK(find_problems(top + "/in/*.dat")[0].name == "b.dat");
  CHECK(find_problems(top + "/missing.dat").size() == 1);
  CHECK_THROWS_AS(find_problems(top + "/in/notes.txt"), Error);
  CHECK_THROWS_AS(find_problems(top + "/in/*.csv"), Error);
  CHECK_THROWS_AS(find_problems("no_problem"), Error);
}
