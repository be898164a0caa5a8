#include "problems/mechanics/solid_fraction.hpp"

#include <stdexcept>

#include "geometry/shape/mass_properties.hpp"
#include "platform/random.hpp"
#include "tests/catch.hpp"

using namespace ballast;

namespace {

/// Unit cubes at the given places, and a floor that must not count.
MechanicalSystem cubes(const std::vector<Vec3>& places, MotionState& state) {
  MechanicalSystem system;
  system.shapes.push_back(std::make_shared<const Polyhedron>(make_box(Vec3(1, 1, 1))));
  for (const Vec3& place : places) {
    RigidBody body;
    body.shape.polyhedron = system.shapes[0].get();
    body.volume = 1.0;
    system.bodies.push_back(body);
    state.pose.push_back({place, Quat::Identity()});
  }
  system.grain_count = static_cast<int>(places.size());
  system.bodies.emplace_back();
  state.pose.emplace_back();
  return system;
}

}  // namespace

TEST_CASE("solid fraction: whole, cut and outer grains") {
  MotionState state;
  const MechanicalSystem system =
      cubes({Vec3(1, 1, 1), Vec3(4, 2, 2), Vec3(0, 0, 3), Vec3(9, 9, 9)}, state);
  ControlVolume volume(Vec3(0, 0, 0), Vec3(4, 4, 4));
  // 1 + 1/2 + 1/4 + 0 of 64
  CHECK(volume.solid_fraction(system, state) == Approx(1.75 / 64.0).epsilon(1e-14));
}

TEST_CASE("solid fraction: a wall of cubes fills the box, wherever the box lies") {
  std::vector<Vec3> places;
  for (int k = 0; k < 216; ++k) places.emplace_back(k % 6, k / 6 % 6, k / 36);
  MotionState state;
  const MechanicalSystem system = cubes(places, state);
  Random random(5);
  for (int trial = 0; trial < 20; ++trial) {
    const double x = random.uniform(0, 2), y = random.uniform(0, 2), z = random.uniform(0, 2);
    const double a = random.uniform(0.1, 3), b = random.uniform(0.1, 3), c = random.uniform(0.1, 3);
    ControlVolume volume(Vec3(x, y, z), Vec3(x + a, y + b, z + c));
    CHECK(volume.solid_fraction(system, state) == Approx(1.0).epsilon(1e-12));
  }
}

TEST_CASE("solid fraction: the same bits whoever shares the work") {
  Random random(11);
  std::vector<Vec3> places;
  for (int k = 0; k < 100; ++k)
    places.emplace_back(random.uniform(0, 4), random.uniform(0, 4), random.uniform(0, 4));
  MotionState state;
  const MechanicalSystem system = cubes(places, state);
  ControlVolume alone(Vec3(0.3, 0.3, 0.3), Vec3(3.3, 3.1, 3.7));
  const double expected = alone.solid_fraction(system, state);
  for (const int threads : {1, 2, 3}) {
    WorkerTeam team;
    team.resize(threads);
    ControlVolume shared(alone.lo(), alone.hi());
    CHECK(shared.solid_fraction(system, state, &team) == expected);
    CHECK(alone.solid_fraction(system, state, &team) == expected);
  }
}

TEST_CASE("a control volume without volume is refused") {
  CHECK_THROWS_AS(ControlVolume(Vec3(0, 0, 0), Vec3(1, -1, 1)), std::invalid_argument);
  CHECK_THROWS_AS(ControlVolume(Vec3(0, 0, 0), Vec3(1, 0, 1)), std::invalid_argument);
  CHECK_THROWS_AS(ControlVolume(Vec3(0, 0, std::nan("")), Vec3(1, 1, 1)), std::invalid_argument);
}
