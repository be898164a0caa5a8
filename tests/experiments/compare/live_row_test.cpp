// A trajectory in numbers, against one made by hand.

#include "experiments/compare/live_row.hpp"

#include <algorithm>
#include <cmath>

#include "tests/catch.hpp"
#include "tests/experiments/compare/hand_made_live.hpp"

using namespace ballast;

TEST_CASE("A trajectory comes to its means, its worst and its end") {
  const LiveComparison live = hand_made_live();
  const std::vector<LiveRow> rows = live_rows(live);
  REQUIRE(rows.size() == 3);
  const LiveRow& r = rows[1];
  CHECK(r.error_mean == Approx(1.5e-2));  // 1.5e-4 m/s over 1e-2 m/s
  CHECK(r.error_max == Approx(2e-2));
  CHECK(r.missed == 0.5);  // the second of two steps
  CHECK(rows[0].missed == 0.0);
  CHECK(r.wall_x == Approx(2.003e-3));
  CHECK(r.force_mean == Approx(15.0));
  CHECK(r.penetration_max == Approx(2e-6));
  CHECK(r.kinetic_energy == 1.0);
  CHECK(r.energy_residual == 0.5);
  CHECK(r.iterations == 15.0);
  CHECK(r.solve_ms_per_step == Approx(1.5));
  CHECK(r.ms_per_step >= r.solve_ms_per_step);
  CHECK(r.distance == Approx(3e-6));
  CHECK(rows[0].distance == 0.0);
  // without steps nothing is known
  CHECK(std::isnan(rows[2].error_mean));
  CHECK(std::isnan(rows[2].missed));
}

TEST_CASE("Without a driven wall or a reference nothing is said of them") {
  LiveComparison live = hand_made_live();
  live.has_driven_wall = false;
  live.reference = -1;
  const std::vector<LiveRow> rows = live_rows(live);
  CHECK(std::isnan(rows[0].wall_x));
  CHECK(std::isnan(rows[0].force_mean));
  CHECK(std::isnan(rows[0].distance));
}

TEST_CASE("Tables of rows and of steps have a line for each") {
  const LiveComparison live = hand_made_live();
  const std::string csv = live_csv(live_rows(live));
  CHECK(std::count(csv.begin(), csv.end(), '\n') == 4);
  CHECK(csv.find("\npgs,coulomb,0.1,complete,2,0.015,0.02,0,0.002,15,") != std::string::npos);
  const std::string steps = steps_csv(live.trajectories[0]);
  CHECK(std::count(steps.begin(), steps.end(), '\n') == 3);
  CHECK(std::count(steps.begin(), steps.begin() + static_cast<long>(steps.find('\n')), ',') + 1 ==
        static_cast<long>(step_columns().size()));
}
