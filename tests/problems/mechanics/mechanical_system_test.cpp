#include "problems/mechanics/mechanical_system.hpp"

#include <stdexcept>

#include "platform/random.hpp"
#include "tests/catch.hpp"
#include "tests/support/cube_scene.hpp"

using namespace ballast;

namespace {

/// A free cube, a cube that only slides along y, a floor, and a driven wall at x = 0.5.
Scene two_cubes_and_two_walls() {
  Scene scene = empty_scene();
  scene.friction = 0.5;
  scene.bodies = {cube("free", 0.1, 2.0, Vec3(0, 0, 1)), cube("rail", 0.2, 3.0, Vec3(0.3, 0, 1))};
  BodySpec& rail = scene.bodies[1];
  rail.free[0] = rail.free[2] = rail.free_rotation = false;
  WallSpec driven;
  driven.name = "piston";
  driven.normal = Vec3(-1, 0, 0);
  driven.offset = -0.5;
  driven.motion = WallMotion::driven;
  driven.mass = 7.0;
  driven.friction = 0.0;
  scene.walls = {floor_at_zero(0.3), driven};
  return scene;
}

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

TEST_CASE("bodies come before walls, with the freedom that each has") {
  MotionState state, none;
  Scene scene = two_cubes_and_two_walls();
  const MechanicalSystem system = make_system(scene, state);
  REQUIRE(system.bodies.size() == 4);
  CHECK(system.grain_count == 2);
  CHECK(system.mass_of_grains() == 5.0);
  CHECK(system.first_driven_wall() == 3);
  const int unknowns[] = {6, 1, 0, 1};
  const bool fixed[] = {false, false, true, false};
  for (size_t b = 0; b < 4; ++b) {
    CHECK(system.bodies[b].freedom.count() == unknowns[b]);
    CHECK(system.bodies[b].shape.fixed == fixed[b]);
    CHECK(system.bodies[b].is_wall() == (b >= 2));
  }
  CHECK(Vec3(system.bodies[1].freedom.axes.col(0)) == Vec3::UnitY());
  CHECK(Vec3(system.bodies[3].freedom.axes.col(0)) == Vec3::UnitX());  // outward
  CHECK(system.bodies[0].volume == Approx(1e-3));
  CHECK(system.bodies[3].mass == 7.0);
  CHECK(state.pose[0].position == Vec3(0, 0, 1));
  CHECK(state.pose[3].position == Vec3(0.5, 0, 0));
  CHECK(contact_shapes(system).size() == 4);
  scene.walls.pop_back();
  CHECK(make_system(scene, none).first_driven_wall() == -1);
}

TEST_CASE("a driven wall's way and speed are counted outward, from where it began") {
  MotionState state;
  const MechanicalSystem system = make_system(two_cubes_and_two_walls(), state);
  CHECK(outward_displacement(system, state, 3) == 0.0);
  state.pose[3].position.x() += 0.25;
  state.velocity[3] = Vec3(-1.5, 0, 0);
  CHECK(outward_displacement(system, state, 3) == 0.25);
  CHECK(outward_velocity(system, state, 3) == -1.5);
}

TEST_CASE("solid fraction: whole, cut and outer grains") {
  MotionState state;
  const MechanicalSystem system =
      cubes({Vec3(1, 1, 1), Vec3(4, 2, 2), Vec3(0, 0, 3), Vec3(9, 9, 9)}, state);
  ControlVolume volume(Vec3(0, 0, 0), Vec3(4, 4, 4));
  // 1 + 1/2 + 1/4 + 0 of the volume 64.
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
