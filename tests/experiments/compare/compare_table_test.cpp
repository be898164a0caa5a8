// Means of a comparison against a table worked out by hand.

#include "experiments/compare/compare_table.hpp"

#include <cmath>

#include "tests/catch.hpp"
#include "tests/experiments/compare/hand_made_row.hpp"

using namespace ballast;

TEST_CASE("Times are medians over repeats, and solved is what every repeat solves") {
  const std::vector<CompareRow> rows = {hand_made_row("x", "a", 3.0, Verdict::solved, 0),
                                        hand_made_row("x", "a", 1.0, Verdict::solved, 1),
                                        hand_made_row("x", "a", 2.0, Verdict::solved, 2),
                                        hand_made_row("x", "b", 1.0, Verdict::solved, 0),
                                        hand_made_row("x", "b", 60.0, Verdict::timeout, 1),
                                        hand_made_row("broken", "", 0.0, Verdict::unreadable)};
  const std::vector<CompareTable> tables = compare_tables(rows);
  REQUIRE(tables.size() == 1);
  CHECK(tables[0].heading == "Tolerance 0.0001, cold start");
  CHECK(tables[0].cases == 1);
  REQUIRE(tables[0].backends.size() == 2);
  const BackendSummary &a = tables[0].backends[0], &b = tables[0].backends[1];
  CHECK(a.solver == "a");
  CHECK(a.solved == 1);
  CHECK(a.mean_seconds == Approx(2.0));
  CHECK(a.mean_ratio == Approx(1.0));
  CHECK(a.largest_spread == 1.0);
  CHECK(b.solved == 0);
  CHECK(b.mean_seconds == Approx(60.0));  // the limit
}

TEST_CASE("Tables come from the loosest tolerance, and a case counts where it was tried") {
  std::vector<CompareRow> rows = {hand_made_row("x", "a", 1.0, Verdict::solved),
                                  hand_made_row("y", "a", 1.0, Verdict::timeout),
                                  hand_made_row("y", "a", 1.0, Verdict::solved)};
  rows[0].tolerance = 1e-2;
  rows[2].start = StartKind::warm;
  const std::vector<CompareTable> tables = compare_tables(rows);
  REQUIRE(tables.size() == 3);
  CHECK(tables[0].heading == "Tolerance 0.01, cold start");
  CHECK(tables[1].heading == "Tolerance 0.0001, cold start");
  CHECK(tables[2].heading == "Tolerance 0.0001, warm start");
  CHECK(std::isnan(tables[1].backends.at(0).mean_ratio));  // nobody solved anything
}

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
  const std::vector<BackendSummary> all = compare_tables(rows).at(0).backends;
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
  CHECK(all[2].denied == 1);
  CHECK(all[2].solved == 0);
  CHECK(all[2].unsolved == 3);
  CHECK(all[2].no_solutions == 1);
}
