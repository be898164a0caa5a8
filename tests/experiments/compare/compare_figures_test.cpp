// Profiles and costs as figures.

#include "experiments/compare/compare_figures.hpp"

#include "tests/catch.hpp"
#include "tests/experiments/compare/hand_made_row.hpp"

using namespace ballast;

TEST_CASE("A step curve becomes the corners of its stairs") {
  const Curve curve = stairs({{1.0, 3.0}, {0.5, 0.75}}, 10.0, Curve{});
  CHECK(curve.x == std::vector<double>{1.0, 3.0, 3.0, 10.0});
  CHECK(curve.y == std::vector<double>{0.5, 0.5, 0.75, 0.75});
}

TEST_CASE("No two of twenty-four backends look alike") {
  for (size_t a = 0; a < 24; ++a)
    for (size_t b = 0; b < a; ++b) {
      const Curve p = backend_curve(a, "p"), q = backend_curve(b, "q");
      CHECK((p.ink != q.ink || p.dashed != q.dashed || p.width != q.width));
    }
  CHECK(figure_name("pgs 1e-4/x.dat") == "pgs_1e-4_x_dat");
  CHECK(height_for(9) > height_for(2));
}

TEST_CASE("Profiles reach from the fastest to the slowest, and cost needs two places") {
  std::vector<CompareRow> rows;
  for (const char* name : {"x", "y"}) {
    rows.push_back(hand_made_row(name, "a", 0.1, Verdict::solved));
    rows.push_back(hand_made_row(name, "b", 3.0, Verdict::solved));
  }
  const std::vector<CompareTable> tables = compare_tables(rows);
  const auto profiles = profile_figures(tables[0]);
  REQUIRE(profiles.size() == 2);
  CHECK(profiles[0].plot.name == "performance_cold_1e-04");
  CHECK(profiles[0].plot.panels[0].x_max == 100.0);  // the whole decade above 30
  CHECK(profiles[1].plot.panels[0].x_min == 1e-3);   // 0.1 s on 20 contacts: 5 ms each
  const auto costs = cost_figures(tables[0]);        // equal rank deficiency: no figure of it
  REQUIRE(costs.size() == 2);
  CHECK(costs[0].plot.name == "cost_contacts_cold_1e-04");
  CHECK(costs[1].plot.name == "cost_mass_ratio_cold_1e-04");
  rows = {hand_made_row("x", "a", 60.0, Verdict::timeout)};
  CHECK(profile_figures(compare_tables(rows)[0]).empty());
}
