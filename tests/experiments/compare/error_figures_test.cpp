// Error against time: which histories are drawn, and when there is nothing to draw.

#include "experiments/compare/compare_figures.hpp"
#include "tests/catch.hpp"
#include "tests/experiments/compare/hand_made_row.hpp"

using namespace ballast;

TEST_CASE("A case is drawn with each backend's history to its tightest tolerance") {
  std::vector<CompareRow> rows;
  for (const double tolerance : {1e-2, 1e-4}) {
    rows.push_back(hand_made_row("x", "a", tolerance == 1e-2 ? 1.0 : 4.0, Verdict::solved));
    rows.back().tolerance = tolerance;
  }
  rows.push_back(hand_made_row("x", "b", 2.0, Verdict::unsolved));
  rows.push_back(hand_made_row("x", "a", 9.0, Verdict::solved, 1));  // a repeat: not drawn
  rows.push_back(hand_made_row("y", "a", 7.0, Verdict::solved));     // another case
  const Figure figure = work_precision_figure(rows, "x", StartKind::cold).plot;
  CHECK(figure.name == "case_x_cold");
  REQUIRE(figure.panels.size() == 1);
  const Panel& panel = figure.panels[0];
  REQUIRE(panel.curves.size() == 3);
  CHECK(panel.curves[0].title == "a");
  CHECK(panel.curves[0].x.back() == 4.0);
  CHECK(panel.curves[1].mark == Mark::points);  // where a arrived: once for each tolerance
  CHECK(panel.curves[1].x == std::vector<double>{1.0, 4.0});
  CHECK(panel.curves[1].title.empty());
  CHECK(panel.curves[2].title == "b");  // arrived nowhere: a line alone
  REQUIRE(panel.lines.size() == 2);
  CHECK(panel.lines[0].value == 1e-4);
  CHECK(panel.lines[1].value == 1e-2);
  CHECK_FALSE(panel.y_min.has_value());
  CHECK(work_precision_figure(rows, "x", StartKind::warm).plot.panels.empty());
  CHECK(work_precision_figure(rows, "z", StartKind::cold).plot.panels.empty());
}

TEST_CASE("Errors far below rounding do not flatten a figure") {
  std::vector<CompareRow> rows = {hand_made_row("x", "a", 1.0, Verdict::solved)};
  rows[0].history.back().error = 1e-30;
  CHECK(work_precision_figure(rows, "x", StartKind::cold).plot.panels.at(0).y_min == 1e-16);
}

TEST_CASE("A family is a mean over all its cases, or no curve") {
  std::vector<CompareRow> rows;
  for (const char* name : {"x1", "x2"})
    rows.push_back(hand_made_row(name, "a", 1.0, Verdict::solved));
  rows.push_back(hand_made_row("x1", "b", 1.0, Verdict::solved));  // b has no x2
  const Figure figure = family_figure(rows, "hand", StartKind::cold).plot;
  REQUIRE(figure.panels.size() == 1);
  REQUIRE(figure.panels[0].curves.size() == 1);
  CHECK(figure.panels[0].curves[0].title == "a");
  CHECK(figure.panels[0].curves[0].y.back() == Approx(5e-5));
  rows.erase(rows.begin() + 1, rows.end());  // one case is no family
  CHECK(family_figure(rows, "hand", StartKind::cold).plot.panels.empty());
}
