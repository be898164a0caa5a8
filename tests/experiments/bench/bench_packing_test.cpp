// Large packings made of a deposited one.

#include "experiments/bench/bench_packing.hpp"

#include <algorithm>
#include <tuple>

#include "experiments/step/time_step.hpp"
#include "platform/error.hpp"
#include "tests/catch.hpp"
#include "tests/experiments/bench/tiny_box.hpp"

using namespace ballast;

TEST_CASE("Copies side by side are the packing again and again") {
  const DepositedBox& box = tiny_box();
  BenchStart one = tiled_start(box, 1, 1), six = tiled_start(box, 3, 2);
  REQUIRE(six.system.grain_count == 6 * 12);
  REQUIRE(six.state.pose.size() == six.system.bodies.size());
  CHECK(six.system.first_driven_wall() == -1);
  for (size_t c = 1; c < six.memory.contacts.size(); ++c) {
    const ContactPoint &p = six.memory.contacts[c - 1], &q = six.memory.contacts[c];
    CHECK(std::tuple(p.body_a, p.body_b, p.feature) < std::tuple(q.body_a, q.body_b, q.feature));
  }
  // walls between the copies are gone, and with them their contacts alone
  size_t inner = 0;
  for (const ContactPoint& c : one.memory.contacts) {
    const int wall = c.body_a - 12;
    if (wall == wall_x_min || wall == wall_x_max)
      inner += 2 * 2;  // on each side 2 of 3 columns, 2 rows
    if (wall == wall_y_min || wall == wall_y_max) inner += 3;
  }
  CHECK(six.memory.contacts.size() == 6 * one.memory.contacts.size() - inner);
  const auto deepest = [&](BenchStart& start) {
    TimeStepper stepper(start.system, box.scene, -1);
    double depth = 0.0;
    for (int k = 0; k < 5; ++k)
      depth = std::max(depth, stepper.step(start.state, start.memory).penetration_max);
    return depth;
  };
  CHECK(deepest(six) <= deepest(one) + 1e-5);  // no copy lies in another
}

TEST_CASE("A scene without grains has no packing to measure") {
  const TemporaryFolder folder;
  CHECK_THROWS_WITH(deposited_box("sliding_cube", {}, folder.path()),
                    "sliding_cube: has no grains: a bench needs a deposited packing");
}

TEST_CASE("The driven box begins as it was deposited, behind a wall that is driven") {
  const BenchStart start = driven_start(tiny_box());
  CHECK(start.system.grain_count == 12);
  CHECK(start.system.first_driven_wall() >= 0);
  CHECK(start.memory.contacts.size() == start.memory.impulses.size());
  for (size_t b = 0; b < 12; ++b)
    CHECK(start.state.pose[b].position == tiny_box().packing.state.pose[b].position);
}
