#include "experiments/bench/captured_bench.hpp"

#include <algorithm>

#include "experiments/compare/compare_options.hpp"
#include "problems/algebra/known_solutions.hpp"
#include "tests/catch.hpp"
#include "tests/experiments/bench/tiny_box.hpp"

using namespace ballast;

namespace {

/// Two problems with known solutions, as though a run had met them.
std::vector<CompareCase> two_cases() {
  std::vector<CompareCase> cases;
  for (const int seed : {1, 2})
    cases.push_back({"case " + std::to_string(seed), "known", [seed] {
                       KnownSolutionSettings settings;
                       settings.seed = static_cast<std::uint64_t>(seed);
                       const KnownSolution known = make_known_solution(settings);
                       LoadedCase loaded = load_case(known.problem);
                       loaded.warm_start = 0.9 * known.r;
                       loaded.phase = "active";
                       loaded.h = 1e-3;
                       return loaded;
                     }});
  return cases;
}

}  // namespace

TEST_CASE("Cost and every measure are told for each solver, start and tolerance") {
  const TemporaryFolder folder;
  CapturedOptions options;
  options.solvers = parse_solvers("nncg,pgs");
  options.tolerances = {1e-2, 1e-6};
  options.starts = {StartKind::cold, StartKind::warm};
  options.within = {100.0};
  options.folder = folder.path();
  const auto rows = measure_captured(two_cases(), options, [](const CapturedRow&) { return true; });
  REQUIRE(rows.size() == 16);
  for (const CapturedRow& row : rows) {
    CHECK(row.solved);
    CHECK(row.error <= row.tolerance);
    CHECK(row.distance.statuses >= 0);
    CHECK(std::isnan(row.k_art));  // nothing is jammed
  }
  CHECK(rows[1].distance.velocity < 0.01 * rows[0].distance.velocity);
  CHECK(std::filesystem::exists(folder.path() / "exact"));

  const auto measured = captured_measurements(options, rows);
  CHECK(value_of(measured, "nncg, cold, 0.01/solved") == 2.0);
  CHECK(value_of(measured, "pgs, warm, 1e-06/solved within 100 s") == 2.0);
  CHECK(value_of(measured, "pgs, warm, 1e-06/error rms") <= 1e-6);
  const std::string csv = captured_csv(rows);
  CHECK(std::count(csv.begin(), csv.end(), '\n') == 17);

  const Figure figure = captured_figure(options, rows);
  REQUIRE(figure.panels.size() >= 4);  // no wall, no jam: none of theirs
  CHECK(figure.panels[0].curves.size() == 8);
  CHECK(figure.panels[0].curves[0].x.size() == 2);
}

TEST_CASE("What misses a tolerance is not asked for a tighter one") {
  CapturedOptions options;
  options.solvers = parse_solvers("pgs");
  options.tolerances = {1e-2, 1e-200, 1e-300};
  options.max_seconds = 0.05;
  options.exact_seconds = 0.0;
  int heard = 0;
  const auto rows =
      measure_captured(two_cases(), options, [&](const CapturedRow&) { return ++heard < 5; });
  REQUIRE(rows.size() == 5);
  CHECK(rows[0].solved);
  CHECK_FALSE(rows[1].solved);
  CHECK_FALSE(rows[2].solved);
  CHECK(rows[2].tolerance == 1e-300);
  CHECK(rows[2].seconds == rows[1].seconds);
  CHECK(rows[0].distance.statuses == -1);
  // At 1e-300 nothing is solved: no cost, and no point in the figure.
  const Figure figure = captured_figure(options, rows);
  CHECK(figure.panels.at(0).curves.at(0).x.size() == 1);
}
