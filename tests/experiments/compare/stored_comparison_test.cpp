#include "experiments/compare/stored_comparison.hpp"

#include "experiments/run/manifest.hpp"
#include "platform/error.hpp"
#include "tests/catch.hpp"
#include "tests/experiments/compare/hand_made_row.hpp"
#include "tests/support/temporary_folder.hpp"

using namespace ballast;

TEST_CASE("A comparison is read back in the order of its rows, with its machine and program") {
  const TemporaryFolder folder;
  const CompareRow rows[] = {hand_made_row("y", "pgs", 1.0, Verdict::solved),
                             hand_made_row("x", "pgs", 1.0, Verdict::solved, 1),
                             hand_made_row("x", "pgs", 2.0, Verdict::solved),
                             hand_made_row("x", "nncg", 1.0, Verdict::solved)};
  std::filesystem::create_directory(folder.path() / "rows");
  for (size_t k = 0; k < 4; ++k)
    folder.write("rows/" + std::to_string(7 - k) + ".json", to_json(rows[k]));
  folder.write("rows/half.json.tmp", "{");
  Manifest("compare", {}, "key").write(folder.path() / "manifest.json");
  const StoredComparison read = read_comparison(folder.path());
  REQUIRE(read.rows.size() == 4);
  CHECK(read.rows[0].solver == "nncg");
  CHECK(read.rows[1].solve_seconds == 2.0);
  CHECK(read.rows[2].repeat == 1);
  CHECK(read.rows[3].case_name == "y");
  CHECK_THAT(read.machine, Catch::Contains(cpu_model()) && Catch::Contains("cores"));
  CHECK(read.started.size() == 20);
}

TEST_CASE("A folder that is no comparison is refused, and so is a damaged one") {
  const TemporaryFolder folder;
  CHECK_THROWS_WITH(read_comparison(folder.path()), Catch::Contains("no folder of a comparison"));
  std::filesystem::create_directory(folder.path() / "rows");
  folder.write("rows/1.json", "{}");
  CHECK_THROWS_WITH(read_comparison(folder.path()), Catch::Contains("manifest.json"));
  Manifest("compare", {}, "key").write(folder.path() / "manifest.json");
  CHECK_THROWS_WITH(read_comparison(folder.path()), Catch::Contains("1.json: is no row"));
}
