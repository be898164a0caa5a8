// The measure of a roll on fields of known circulation, among them shear and translation.

#include "experiments/measure/run_summary.hpp"

#include <cmath>

#include "tests/catch.hpp"

using namespace ballast;

namespace {

/// Grains on a grid in [0, 2] x [0, 1] of the xz plane, displaced by a function of their place.
template <class Move>
std::vector<Displacement> moved(const Move& move) {
  std::vector<Displacement> list;
  for (int i = 0; i <= 40; ++i)
    for (int k = 0; k <= 20; ++k) {
      const Vec3 place(0.05 * i, 0.3, 0.05 * k);
      list.push_back({place, move(place)});
    }
  return list;
}

constexpr XzRectangle middle{0.5, 1.5, 0.25, 0.75};

}  // namespace

TEST_CASE("a turn as of a rigid body goes round, with twice its angle times the area") {
  const double angle = 0.01;  // clockwise: the top moves to the right
  const auto field =
      moved([&](const Vec3& x) { return Vec3(angle * (x.z() - 0.5), 0, -angle * (x.x() - 1.0)); });
  const Roll roll = roll_of(field, middle, 0.01);
  CHECK(roll.circulation == Approx(2.0 * angle * 0.5));
  CHECK(roll.along[0] == Approx(angle * 0.25));
  CHECK(roll.along[1] == Approx(angle * 0.5));
  CHECK(roll.side_ratio() == Approx(0.5));
  Roll back = roll;
  back.circulation *= -1.0;
  for (double& side : back.along) side *= -1.0;
  CHECK(back.side_ratio() == Approx(0.5));
}

TEST_CASE("shear has a circulation and does not go round, a translation has none") {
  const auto shear = moved([](const Vec3& x) { return Vec3(0.01 * (x.z() - 0.5), 0, 0); });
  const Roll sheared = roll_of(shear, middle, 0.01);
  CHECK(sheared.circulation == Approx(0.01 * 0.5));
  CHECK(sheared.side_ratio() == Approx(0.0).margin(1e-12));
  const Roll carried = roll_of(moved([](const Vec3&) { return Vec3(1, 2, 3); }), middle, 0.01);
  CHECK(carried.circulation == Approx(0.0).margin(1e-12));
  CHECK(carried.side_ratio() <= 0.0);
}

TEST_CASE("a side without a grain makes the roll not known") {
  auto field = moved([](const Vec3&) { return Vec3(1, 0, 0); });
  std::erase_if(field, [](const Displacement& d) { return d.place.z() > 0.6; });
  const Roll roll = roll_of(field, middle, 0.01);
  CHECK(std::isnan(roll.circulation));
  CHECK(std::isnan(roll.side_ratio()));
}

TEST_CASE("the field's cells hold the means of their grains, cells without grains are left out") {
  const auto cells = cell_means(std::vector<Displacement>{{Vec3(0.1, 0, 0.6), Vec3(1, 0, 2)},
                                                          {Vec3(0.2, 0, 0.7), Vec3(3, 0, 2)},
                                                          {Vec3(5, 0, 0), Vec3(9, 9, 9)}},
                                {0, 1, 0, 1}, 2, 2);
  REQUIRE(cells.size() == 1);
  CHECK(cells[0].move.isApprox(Vec3(2, 0, 2)));
  CHECK(cells[0].place.isApprox(Vec3(0.25, 0, 0.75)));
}

TEST_CASE("displacements of whole periods are taken between the frames at their ends") {
  std::vector<MotionState> frames(4);
  for (int k = 0; k < 4; ++k) {
    frames[k].time = 0.1 * k;
    frames[k].pose.resize(2);
    frames[k].pose[0].position.x() = k * k;
  }
  RunSummary run;
  run.facts.step = 1e-4;
  run.facts.grains = 1;
  std::vector<WallPeriod>& periods = run.wall.periods;
  periods.resize(3);
  periods[0].begin = 0.1;
  periods[0].end = 0.2;
  periods[1].begin = 0.2;
  periods[1].end = 0.30005;  // half a step from the frame
  periods[2].begin = 0.3;
  periods[2].end = 0.4;  // has no frame
  const auto moves = period_displacements(frames, run);
  REQUIRE(moves.size() == 2);
  CHECK(moves[0].move.x() == 3.0);
  CHECK(moves[1].move.x() == 5.0);
  CHECK(moves[1].place.x() == 6.5);
}
