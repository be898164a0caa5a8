// Words of the command line -> cases from files, folders and patterns.

#include "experiments/compare/compare_case.hpp"

#include "platform/error.hpp"
#include "tests/catch.hpp"
#include "tests/support/temporary_folder.hpp"

using namespace ballast;

TEST_CASE("Cases from files: families, names, and what is refused") {
  CHECK(family_of_file("Capsules-i101-404.dat") == "Capsules");
  CHECK(family_of_file("Rover1039.dat") == "Rover");
  CHECK(family_of_file("NESpheres_30_1.dat") == "NESpheres");
  const TemporaryFolder folder;
  CHECK_THROWS_AS(compare_cases({"/no/such/*.dat"}), Error);
  CHECK_THROWS_AS(compare_cases({"known"}), Error);
  CHECK_THROWS_AS(compare_cases({folder.path().string()}), Error);
  CHECK_THROWS_AS(compare_cases({folder.write("notes.txt", "").string()}), Error);
  folder.write("b.dat", "3 0 0 0 0");
  folder.write("a.dat", "3 0 0 0 0");
  const std::vector<CompareCase> cases =
      compare_cases({(folder.path() / "*.dat").string(), folder.path().string()});
  REQUIRE(cases.size() == 4);
  CHECK(cases[0].name == "a.dat");
  CHECK(cases[2].name == "a.dat (2)");
  CHECK(cases[1].word == (folder.path() / "b.dat").string());
}

TEST_CASE("Folders are searched to the bottom, and only for problems") {
  const TemporaryFolder folder;
  std::filesystem::create_directories(folder.path() / "deep" / "deeper");
  folder.write("deep/deeper/Rover2.dat", "");
  folder.write("deep/Rover1.dat", "");
  folder.write("deep/readme.md", "");
  const std::vector<CompareCase> cases = compare_cases({folder.path().string()});
  REQUIRE(cases.size() == 2);
  CHECK(cases[0].family == "Rover");
  CHECK(cases[0].name == "Rover1.dat");
  CHECK(cases[1].name == "Rover2.dat");
}

TEST_CASE("A file that is missing or broken is a case, and says why when it is loaded") {
  const TemporaryFolder folder;
  const std::string broken = folder.write("broken.hdf5", "no HDF5 at all").string();
  const std::string missing = (folder.path() / "missing.dat").string();
  const std::vector<CompareCase> cases = compare_cases({missing, broken});
  REQUIRE(cases.size() == 2);
  CHECK(cases[0].name == "missing.dat");
  CHECK(cases[1].name == "broken.hdf5");
  CHECK_THROWS_WITH(cases[0].load(), Catch::Contains(missing) && Catch::Contains("no such file"));
  CHECK_THROWS_WITH(cases[1].load(), Catch::Contains(broken));
}
