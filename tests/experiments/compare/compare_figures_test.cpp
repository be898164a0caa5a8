// Profiles as figures.

#include "experiments/compare/compare_figures.hpp"

#include "tests/catch.hpp"
#include "tests/experiments/compare/hand_made_row.hpp"

using namespace ballast;

TEST_CASE("No two of twenty-four backends look alike") {
  for (size_t a = 0; a < 24; ++a)
    for (size_t b = 0; b < a; ++b) {
      const Curve p = backend_curve(a, "p"), q = backend_curve(b, "q");
      CHECK((p.ink != q.ink || p.dashed != q.dashed || p.width != q.width));
    }
  CHECK(figure_name("pgs 1e-4/x.dat") == "pgs_1e-4_x_dat");
  CHECK(height_for(9) > height_for(2));
}

TEST_CASE("Profiles reach from the fastest to the slowest, in stairs") {
  std::vector<CompareRow> rows;
  for (const char* name : {"x", "y"}) {
    rows.push_back(hand_made_row(name, "a", 0.1, Verdict::solved));
    rows.push_back(hand_made_row(name, "b", 3.0, Verdict::solved));
  }
  const std::vector<CompareTable> tables = compare_tables(rows);
  const auto profiles = profile_figures(tables[0]);
  REQUIRE(profiles.size() == 2);
  CHECK(profiles[0].plot.name == "performance_cold_1e-04");
  CHECK(profiles[0].plot.panels[0].x_max == 100.0);          // the whole decade above 30
  CHECK(profiles[1].plot.panels[0].x_min == 1e-3);           // 0.1 s on 20 contacts: 5 ms each
  const Curve& b = profiles[0].plot.panels[0].curves.at(1);  // thirty times the fastest on both
  CHECK(b.x == std::vector<double>{1.0, 30.0, 30.0, 100.0});
  CHECK(b.y == std::vector<double>{0.0, 0.0, 1.0, 1.0});
  rows = {hand_made_row("x", "a", 60.0, Verdict::timeout)};
  CHECK(profile_figures(compare_tables(rows)[0]).empty());
}
