// What a simulated second, and a captured problem, costs at which error.

#include "experiments/bench/accuracy_bench.hpp"

#include "experiments/compare/comparison.hpp"
#include "tests/catch.hpp"
#include "tests/experiments/bench/tiny_box.hpp"

using namespace ballast;

TEST_CASE("More iterations cost more and err less") {
  const TemporaryFolder folder;
  LiveOptions live;
  live.scene = "vibrated_box_small";
  live.overrides = tiny;
  live.solvers = parse_solvers("pgs");
  live.tolerances = {1e-8};
  live.iterations = {2, 30};
  live.duration = 4e-3;
  live.folder = folder.path();
  const Silence silence;
  std::vector<std::string> labels;
  const LiveComparison made = measure_accuracy(live, [&](const Trajectory& t) {
    labels.push_back(t.label());
    return true;
  });
  CHECK(labels == std::vector<std::string>{"pgs 1e-08", "pgs 2 iterations", "pgs 30 iterations"});
  REQUIRE(made.trajectories.size() == 3);
  for (const Trajectory& t : made.trajectories) CHECK(t.is_complete());
  CHECK(made.reference == 0);
  const std::vector<Measurement> all = accuracy_measurements(made);
  CHECK(value_of(all, "pgs 1e-08/error_max") <= 1e-8);
  CHECK(value_of(all, "pgs 1e-08/distance_end") == 0.0);
  CHECK(value_of(all, "pgs 2 iterations/iterations_mean") == 2.0);
  CHECK(value_of(all, "pgs 2 iterations/error_mean") >
        value_of(all, "pgs 30 iterations/error_mean"));
  CHECK(value_of(all, "pgs 2 iterations/distance_end") > 0.0);
  // 2e-4 s a step: a second of them
  CHECK(value_of(all, "pgs 30 iterations/cost of a simulated second") ==
        Approx(5.0 * value_of(all, "pgs 30 iterations/ms_per_step")));
  CHECK(accuracy_figure(made).panels[0].curves.at(0).x.size() == 3);
}

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
  const auto measured = captured_measurements(rows);
  CHECK(value_of(measured, "nncg, warm, 0.01/solved") == 3.0);
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
