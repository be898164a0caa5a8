// Profiles and means of a comparison against a table worked out by hand.

#include "experiments/compare/compare_table.hpp"

#include <cmath>
#include <limits>

#include "tests/catch.hpp"
#include "tests/experiments/compare/hand_made_row.hpp"

using namespace ballast;

TEST_CASE("Profiles of costs made by hand") {
  constexpr double inf = std::numeric_limits<double>::infinity();
  // Four cases, three solvers. a is fastest on 1 and 2, b on 3, nobody solves 4.
  const CompareCosts ratios = {{1.0, 2.0, inf}, {1.0, 4.0, 3.0}, {3.0, 1.0, inf}, {inf, inf, inf}};
  const std::vector<StepCurve> curves = cost_profiles(ratios, 1.0, 10.0);
  REQUIRE(curves.size() == 3);
  CHECK(curves[0].x == std::vector<double>{1.0, 3.0});
  CHECK(curves[0].y == std::vector<double>{0.5, 0.75});
  CHECK(curves[1].x == std::vector<double>{1.0, 2.0, 4.0});
  CHECK(curves[1].y == std::vector<double>{0.25, 0.5, 0.75});
  CHECK(curves[2].x == std::vector<double>{1.0, 3.0});
  CHECK(curves[2].y == std::vector<double>{0.0, 0.25});
  // from less than the least
  CHECK(cost_profiles(ratios, 0.1, 10.0)[0].x == std::vector<double>{0.1, 1.0, 3.0});
}

TEST_CASE("Shifted geometric means") {
  const std::vector<double> a = {1.0, 100.0}, b = {4.0, 25.0};
  CHECK(shifted_geometric_mean(a, 0.0) == Approx(10.0));
  CHECK(shifted_geometric_mean(a, 1.0) == Approx(std::sqrt(2.0 * 101.0) - 1.0));
  CHECK(shifted_geometric_ratio(a, b, 0.0) == Approx(1.0));
  CHECK(shifted_geometric_ratio(a, b, 5.0) == Approx(std::sqrt(6.0 / 9.0 * 105.0 / 30.0)));
}

TEST_CASE("Cells: medians over repeats, solved only when every repeat is") {
  const std::vector<CompareRow> rows = {hand_made_row("x", "a", 3.0, Verdict::solved, 0),
                                        hand_made_row("x", "a", 1.0, Verdict::solved, 1),
                                        hand_made_row("x", "a", 2.0, Verdict::solved, 2),
                                        hand_made_row("x", "b", 1.0, Verdict::solved, 0),
                                        hand_made_row("x", "b", 60.0, Verdict::timeout, 1)};
  const std::vector<CompareTable> tables = compare_tables(rows);
  REQUIRE(tables.size() == 1);
  const CompareCell& a = tables[0].cells[0][0];
  CHECK(a.solved);
  CHECK(a.median == 2.0);
  CHECK(a.spread == 1.0);
  CHECK(a.row == &rows[1]);
  CHECK_FALSE(tables[0].cells[0][1].solved);
  CHECK(std::isinf(tables[0].cells[0][1].median));
  CHECK(tables[0].fastest(0) == 2.0);
  CHECK(tables[0].time_ratios()[0][0] == 1.0);
  CHECK(tables[0].times_per_contact()[0][0] == 0.2);
  CHECK(std::isinf(tables[0].time_ratios()[0][1]));
  CHECK(tables[0].heading() == "Tolerance 0.0001, cold start");
  CHECK(backend_summaries(tables[0], 60.0).at(0).largest_spread == 1.0);
}

TEST_CASE("Errors of histories fall") {
  CompareRow r = hand_made_row("x", "a", 1.0, Verdict::solved);
  r.prepare_seconds = 0.25;
  r.history = {{0, 0.0, 1.0}, {1, 1.0, 1e-2}, {2, 2.0, 1e-1}, {3, 3.0, 1e-4}};
  const StepCurve best = best_so_far(r);
  CHECK(best.x == std::vector<double>{0.25, 1.25, 3.25});
  CHECK(best.y == std::vector<double>{1.0, 1e-2, 1e-4});
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
  CHECK(all[2].denied == 1);
  CHECK(all[2].solved == 0);
  CHECK(all[2].unsolved == 3);
  CHECK(all[2].no_solutions == 1);
}
