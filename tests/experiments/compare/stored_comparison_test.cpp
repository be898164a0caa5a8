#include "experiments/compare/stored_comparison.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "experiments/compare/compare_page.hpp"
#include "experiments/run/run_folder.hpp"
#include "platform/atomic_file.hpp"
#include "tests/catch.hpp"
#include "tests/experiments/compare/hand_made_row.hpp"
#include "tests/support/page_sample.hpp"
#include "tests/support/temporary_folder.hpp"

using namespace ballast;

TEST_CASE("A comparison is read back in the order of its rows, with its machine and program") {
  const TemporaryFolder folder;
  CompareRow rows[] = {hand_made_row("y", "pgs", 1.0, Verdict::solved),
                       hand_made_row("x", "pgs", 1.0, Verdict::solved, 1),
                       hand_made_row("x", "pgs", 2.0, Verdict::solved),
                       hand_made_row("x", "nncg", 1.0, Verdict::solved),
                       hand_made_row("x", "older", 1.0, Verdict::solved)};
  std::filesystem::create_directory(folder.path() / "rows");
  for (size_t k = 0; k < 5; ++k) {
    rows[k].key = std::to_string(7 - k);
    folder.write("rows/" + rows[k].key + ".json", to_json(rows[k]));
  }
  folder.write("rows/half.json.tmp", "{");
  // The last row is of another program or limit: the folder's table does not have it.
  folder.write("results.csv", compare_csv(std::span(rows).first(4)));
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
  CHECK_THROWS_WITH(read_comparison(folder.path()), Catch::Contains("results.csv"));
  CompareRow row = hand_made_row("x", "pgs", 1.0, Verdict::solved);
  row.key = "1";
  folder.write("results.csv", compare_csv({&row, 1}));
  CHECK_THROWS_WITH(read_comparison(folder.path()), Catch::Contains("1.json: is no row"));
}

namespace {

CompareRow solve_of(const char* content, const char* name, const char* solver, double seconds) {
  CompareRow row = hand_made_row(name, solver, seconds, Verdict::solved);
  row.facts.content = content;
  return row;
}

/// Comparisons on two machines, of which the fast one measured one solve twice.
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
  const MergedComparison all = merged(three_comparisons());
  CHECK(all.machines == std::vector<std::string>{"fast", "slow"});
  REQUIRE(all.rows.size() == 5);
  CHECK(all.rows[0].solver == "nncg");
  CHECK(all.rows[1].solve_seconds == 2.0);
  // A problem is identified by its content, under one name in all comparisons; another problem has
  // another name. Times are compared within one machine only: a case belongs to one.
  const char* names[] = {"M1 · x", "M1 · x", "M2 · x", "M2 · x", "M2 · x (2)"};
  for (size_t k = 0; k < 5; ++k) CHECK(all.rows[k].case_name == names[k]);
  // pgs over nncg is 2 on the fast machine and 4 on the slow one.
  const std::vector<BackendSummary> backends = compare_tables(all.rows).at(0).backends;
  CHECK(backends.at(0).solver == "pgs");
  CHECK(backends[0].mean_ratio == Approx(std::cbrt(2.0 * 4.0)).epsilon(1e-3));
  // Jobs on one machine are one comparison.
  auto comparisons = three_comparisons();
  comparisons.pop_back();
  CHECK(merged(comparisons).rows[1].case_name == "x");
}

TEST_CASE("Merged comparisons are a page and a table, and who made what is noted") {
  const TemporaryFolder folder;
  const std::filesystem::path all = folder.path() / "all";
  write_merged(all, write_origins(all, three_comparisons(), "ballast compare merge"));
  const std::string csv = read_whole_file(all / "results.csv");
  CHECK(std::count(csv.begin(), csv.end(), '\n') == 6);
  CHECK_THAT(read_whole_file(all / "manifest.json"),
             Catch::Contains("\"slow\": \"M2: slow; a; 2026-01-15\""));
  const std::string page = read_whole_file(all / "compare.html");
  if (page::has_chart_library()) CHECK_THAT(page_data(page), Catch::Contains("M1 · x"));
  CHECK_THROWS_WITH(write_origins(folder.path(), {}, ""), Catch::Contains("have no rows"));
}

TEST_CASE("Two measures are not one table") {
  auto comparisons = three_comparisons();
  comparisons[2].rows[0].measure = Measure::fclib;
  CHECK_THROWS_WITH(merged(comparisons),
                    Catch::Contains("natural_map") && Catch::Contains("fclib"));
}

namespace {

CompareRow row(const std::string& content, double seconds, Verdict verdict = Verdict::solved) {
  CompareRow made;
  made.case_name = content;
  made.facts.content = content;
  made.solver = "pgs";
  made.tolerance = 1e-4;
  made.solve_seconds = seconds;
  made.verdict = verdict;
  return made;
}

}  // namespace

TEST_CASE("Each change has its word, and what matters comes first") {
  const std::vector<CompareRow> before = {row("slower", 1.0),
                                          row("faster", 1.0),
                                          row("same", 1.0),
                                          row("lost", 1.0),
                                          row("only before", 1.0),
                                          row("gained", 9.0, Verdict::timeout),
                                          row("never", 9.0, Verdict::crashed)};
  const std::vector<CompareRow> after = {row("slower", 1.2),
                                         row("faster", 0.8),
                                         row("same", 1.05),
                                         row("lost", 9.0, Verdict::timeout),
                                         row("gained", 1.0),
                                         row("only after", 1.0),
                                         row("never", 9.0, Verdict::unsolved)};
  const auto changes = compare_diff(before, after, 1.1);
  REQUIRE(changes.size() == 8);
  CHECK(changes[0].change == Change::lost);
  CHECK(changes[1].change == Change::slower);
  CHECK(changes[1].before == 1.0);
  CHECK(changes[1].after == 1.2);
  for (const ChangedSolve& solve : changes) {
    const std::string& name = solve.row->case_name;
    INFO(name << ": " << name_of(solve.change));
    CHECK((name == "never" ? "same" : name) == name_of(solve.change));
  }
}

TEST_CASE("A change within the spread of the repeats is none") {
  const std::vector<CompareRow> before = {row("a", 1.0), row("a", 1.1), row("a", 1.5)};
  const auto with = [&](double seconds) {
    const std::vector<CompareRow> after = {row("a", seconds)};
    const auto changes = compare_diff(before, after, 1.05);
    REQUIRE(changes.size() == 1);
    return changes[0];
  };
  CHECK(with(1.3).spread == 1.5);
  CHECK(with(1.3).before == 1.1);
  CHECK(with(1.3).change == Change::same);
  CHECK(with(1.7).change == Change::slower);
  CHECK(with(0.7).change == Change::faster);
}

TEST_CASE("A solve of which one repeat is not solved any more is lost") {
  const std::vector<CompareRow> before = {row("a", 1.0), row("a", 1.1)};
  const std::vector<CompareRow> after = {row("a", 1.0), row("a", 9.0, Verdict::timeout)};
  CHECK(compare_diff(before, after, 1.1).at(0).change == Change::lost);
  CHECK(compare_diff(after, before, 1.1).at(0).change == Change::gained);
}

TEST_CASE("Between two machines only what is lost counts") {
  const double never = std::numeric_limits<double>::infinity();
  const std::vector<CompareRow> before = {row("a", 1.0), row("b", 1.0)};
  const std::vector<CompareRow> after = {row("a", 50.0), row("b", 9.0, Verdict::unsolved)};
  const auto changes = compare_diff(before, after, never);
  CHECK(changes.at(0).change == Change::lost);
  CHECK(changes.at(1).change == Change::same);
}
