// A comparison in a few numbers: what half of the problems cost, and how wrong their answers are.

#include "experiments/bench/captured_bench.hpp"

#include "tests/experiments/bench/tiny_box.hpp"

using namespace ballast;

namespace {

/// Three problems by one solver; the third is not solved to the tight tolerance.
std::vector<CompareRow> rows_made_by_hand() {
  std::vector<CompareRow> rows;
  for (const double tolerance : {1e-2, 1e-6})
    for (const double seconds : {1.0, 3.0, 2.0}) {
      CompareRow& row = rows.emplace_back();
      row.solver = "nncg";
      row.tolerance = tolerance;
      row.start = StartKind::warm;
      row.solve_seconds = seconds;
      row.error = 0.5 * tolerance;
      row.distance.velocity = 10.0 * tolerance;
      row.distance.statuses = 2;
      row.facts.contacts = 8;
      row.verdict = tolerance < 1e-2 && seconds == 2.0 ? Verdict::timeout : Verdict::solved;
    }
  return rows;
}

}  // namespace

TEST_CASE("Cost and every measure are told for each solver, start and tolerance") {
  std::vector<CompareRow> rows = rows_made_by_hand();
  rows.emplace_back().verdict = Verdict::unreadable;
  const std::vector<double> within{2.5};
  const auto measured = captured_measurements(rows, within);
  CHECK(value_of(measured, "nncg, warm, 0.01/solved") == 3.0);
  CHECK(value_of(measured, "nncg, warm, 0.01/solved within 2.5 s") == 2.0);
  CHECK(value_of(measured, "nncg, warm, 0.01/cost") == 2.0);
  CHECK(value_of(measured, "nncg, warm, 1e-06/solved") == 2.0);
  CHECK(value_of(measured, "nncg, warm, 1e-06/error rms") == 5e-7);
  CHECK(value_of(measured, "nncg, warm, 1e-06/wrong statuses") == 0.25);
  for (const Measurement& m : measured) CHECK(m.name != "distance of the wall's force");
}

TEST_CASE("A point stands where half of the problems are solved") {
  std::vector<CompareRow> rows = rows_made_by_hand();
  Figure figure = captured_figure(rows);
  REQUIRE(figure.panels.size() == 3);  // nothing is known of impulses and walls
  REQUIRE(figure.panels[0].curves.size() == 2);
  // what is not solved costs more than what is
  CHECK(figure.panels[0].curves[0].x == std::vector<double>{2.0, 3.0});
  CHECK(figure.panels[0].curves[0].title == "nncg, warm");
  CHECK(figure.panels[1].curves[0].y == std::vector<double>{10.0 * 1e-2, 10.0 * 1e-6});
  rows[3].verdict = Verdict::unsolved;
  CHECK(captured_figure(rows).panels[0].curves[0].x == std::vector<double>{2.0});
}
