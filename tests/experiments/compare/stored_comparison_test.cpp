#include "experiments/compare/stored_comparison.hpp"

#include "experiments/compare/compare_table.hpp"
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

namespace {

CompareRow solve_of(const char* content, const char* name, const char* solver, double seconds) {
  CompareRow row = hand_made_row(name, solver, seconds, Verdict::solved);
  row.facts.content = content;
  return row;
}

/// Two machines; the fast one was asked twice.
std::vector<StoredComparison> three_comparisons() {
  return {{"new", "fast", "b", "2026-02-01", {solve_of("1", "x", "pgs", 2.0)}},
          {"old",
           "fast",
           "a",
           "2026-01-01",
           {solve_of("1", "x", "pgs", 1.0), solve_of("1", "x", "nncg", 1.0)}},
          {"slow",
           "slow",
           "a",
           "2026-01-15",
           {solve_of("1", "other", "pgs", 40.0), solve_of("1", "other", "nncg", 10.0),
            solve_of("2", "x", "pgs", 5.0)}}};
}

}  // namespace

TEST_CASE("Of each solve on a machine the newest comparison's rows count") {
  const auto comparisons = three_comparisons();
  const auto machines = merged_machines(comparisons);
  REQUIRE(machines.size() == 2);
  CHECK(machines[0].machine == "fast");
  CHECK(machines[0].sources == std::vector<size_t>{1, 0});
  REQUIRE(machines[0].rows.size() == 2);
  CHECK(machines[0].rows[0].solver == "nncg");
  CHECK(machines[0].rows[1].solve_seconds == 2.0);
  // A problem is what it holds: it has one name everywhere, and another one has another.
  CHECK(machines[1].rows[0].case_name == "x");
  CHECK(machines[1].rows[2].case_name == "x (2)");
}

TEST_CASE("Ratios are within a machine") {
  const auto machines = merged_machines(three_comparisons());
  const auto pooled = pooled_rows(machines);
  const auto tables = compare_tables(pooled);
  REQUIRE(tables.size() == 1);
  CHECK(tables[0].cases == std::vector<std::string>{"M1 · x", "M2 · x", "M2 · x (2)"});
  // pgs over nncg: 2 on the fast machine, 4 on the slow one; what one backend tried is left out
  const CompareTable common = tried_by_all(tables[0]);
  CHECK(common.cases.size() == 2);
  const auto profiles = cost_profiles(common.time_ratios(), 1.0, 100.0);
  const size_t pgs = common.solvers[0] == "pgs" ? 0 : 1;
  CHECK(profiles[pgs].x == std::vector<double>{1.0, 2.0, 4.0});
  CHECK(profiles[pgs].y == std::vector<double>{0.0, 0.5, 1.0});
}

TEST_CASE("Two measures are not one table") {
  auto comparisons = three_comparisons();
  comparisons[2].rows[0].measure = Measure::fclib;
  CHECK_THROWS_WITH(pooled_rows(merged_machines(comparisons)),
                    Catch::Contains("natural_map") && Catch::Contains("fclib"));
}
