// Profiles and means of a comparison against a table worked out by hand.

#include "experiments/compare/compare_table.hpp"

#include <cmath>
#include <limits>

#include "tests/catch.hpp"
#include "tests/experiments/compare/hand_made_row.hpp"

using namespace ballast;

namespace {

constexpr double inf = std::numeric_limits<double>::infinity();

/// Four cases, three solvers. a is fastest on 1 and 2, b on 3, nobody solves 4.
const std::vector<std::vector<double>> hand_made = {
    {1.0, 2.0, inf}, {2.0, 8.0, 6.0}, {9.0, 3.0, inf}, {inf, inf, inf}};

}  // namespace

TEST_CASE("Performance profiles of a table made by hand") {
  const std::vector<StepCurve> curves = performance_profiles(hand_made, 10.0);
  REQUIRE(curves.size() == 3);
  // a: ratios 1, 1, 3, inf
  CHECK(curves[0].x == std::vector<double>{1.0, 3.0});
  CHECK(curves[0].y == std::vector<double>{0.5, 0.75});
  // b: 2, 4, 1, inf
  CHECK(curves[1].x == std::vector<double>{1.0, 2.0, 4.0});
  CHECK(curves[1].y == std::vector<double>{0.25, 0.5, 0.75});
  // c: inf, 3, inf, inf
  CHECK(curves[2].x == std::vector<double>{1.0, 3.0});
  CHECK(curves[2].y == std::vector<double>{0.0, 0.25});
}

TEST_CASE("Data profiles of a table made by hand") {
  const std::vector<double> sizes = {1.0, 2.0, 3.0, 1.0};
  const std::vector<StepCurve> curves = data_profiles(hand_made, sizes, 0.1, 100.0);
  // a: 1, 1, 3, inf per contact
  CHECK(curves[0].x == std::vector<double>{0.1, 1.0, 3.0});
  CHECK(curves[0].y == std::vector<double>{0.0, 0.5, 0.75});
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
  CHECK(a.fastest == 1.0);
  CHECK(a.slowest == 3.0);
  CHECK(a.row == &rows[1]);
  CHECK_FALSE(tables[0].cells[0][1].solved);
  CHECK(std::isinf(tables[0].cells[0][1].median));
  CHECK(tables[0].fastest(0) == 2.0);
}

TEST_CASE("Errors of histories fall, and their means are taken at equal times") {
  CompareRow r = hand_made_row("x", "a", 1.0, Verdict::solved);
  r.prepare_seconds = 0.25;
  r.history = {{0, 0.0, 1.0}, {1, 1.0, 1e-2}, {2, 2.0, 1e-1}, {3, 3.0, 1e-4}};
  const StepCurve best = best_so_far(r);
  CHECK(best.x == std::vector<double>{0.25, 1.25, 3.25});
  CHECK(best.y == std::vector<double>{1.0, 1e-2, 1e-4});
  const std::vector<StepCurve> curves = {best, {{0.0, 2.0}, {1.0, 1e-4}}};
  const std::vector<double> times = {0.1, 1.5, 2.0, 4.0};
  const std::vector<double> mean = mean_error_at(curves, times);
  CHECK(mean[0] == Approx(1.0));
  CHECK(mean[1] == Approx(1e-1));
  CHECK(mean[2] == Approx(1e-3));
  CHECK(mean[3] == Approx(1e-4));
}
