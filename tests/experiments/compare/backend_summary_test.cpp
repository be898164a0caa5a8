// Backends side by side, against rows made by hand.

#include "experiments/compare/backend_summary.hpp"

#include <cmath>

#include "tests/catch.hpp"
#include "tests/experiments/compare/hand_made_row.hpp"

using namespace ballast;

TEST_CASE("Who solves most comes first, and what was not solved counts with the limit") {
  std::vector<CompareRow> rows = {
      hand_made_row("x", "a", 1.0, Verdict::solved),
      hand_made_row("y", "a", 60.0, Verdict::timeout),
      hand_made_row("x", "b", 2.0, Verdict::solved),
      hand_made_row("y", "b", 8.0, Verdict::solved),
      hand_made_row("x", "c", 0.0, Verdict::crashed),
      hand_made_row("y", "c", 0.5, Verdict::denied),
      hand_made_row("z", "c", 0.5, Verdict::no_solution),
  };
  CHECK(limit_of(rows) == 60.0);
  const std::vector<CompareTable> tables = compare_tables(rows);
  const std::vector<BackendSummary> all = backend_summaries(tables.at(0), 60.0);
  REQUIRE(all.size() == 3);
  CHECK(all[0].solver == "b");
  CHECK(all[0].solved == 2);
  CHECK(all[0].mean_seconds == Approx(std::sqrt(2.001 * 8.001) - 0.001));
  CHECK(all[0].mean_ratio == Approx(std::sqrt(2.001 / 1.001)));
  CHECK(all[1].solver == "a");
  CHECK(all[0].unsolved == 0);
  CHECK(all[1].timeouts == 1);
  CHECK(all[1].unsolved == 1);  // in the mean with the limit
  CHECK(all[1].mean_seconds == Approx(std::sqrt(1.001 * 60.001) - 0.001));
  CHECK(all[2].solver == "c");
  CHECK(all[2].crashes == 1);
  CHECK(all[2].false_successes == 1);
  CHECK(all[2].solved == 0);
  CHECK(all[2].unsolved == 3);
  CHECK(all[2].no_solutions == 1);
}

TEST_CASE("The spread is over repeats") {
  const std::vector<CompareRow> rows = {hand_made_row("x", "a", 1.0, Verdict::solved, 0),
                                        hand_made_row("x", "a", 3.0, Verdict::solved, 1)};
  const std::vector<CompareTable> tables = compare_tables(rows);
  CHECK(backend_summaries(tables.at(0), 60.0).at(0).largest_spread == 1.0);
  CHECK(heading_of(tables[0]) == "Tolerance 0.0001, cold start");
}

TEST_CASE("The terminal hears of every backend and of every ratio to the reference") {
  const std::vector<CompareRow> rows = {hand_made_row("x.dat", "a", 2.0, Verdict::solved),
                                        hand_made_row("x.dat", "auto", 4.0, Verdict::solved)};
  ReferenceTimes theirs;
  theirs.tolerance = 1e-4;
  theirs.entries["x"] = {1.0, "NSGS"};
  const std::string said = compare_summary(rows, std::vector<ReferenceTimes>{theirs});
  CHECK_THAT(said, Catch::Contains("Tolerance 0.0001, cold start, 1 cases"));
  CHECK_THAT(said, Catch::Contains("shift 1 ms: our fastest / theirs 2, auto / theirs 4"));
  CHECK_THAT(said, !Catch::Contains("CLAIMS DENIED"));
}
