// Islands at rest that are not solved at all: sleep on = off within the tolerance, who wakes, and
// the same bits after a stop.

#include "experiments/run/run.hpp"
#include "platform/error.hpp"
#include "tests/experiments/step/stacks.hpp"
#include "tests/support/temporary_folder.hpp"

using namespace ballast;

namespace {

/// Stacks, and a cube that falls flat on the first one after 0.32 s (320 steps). Struck by a corner
/// the stack would have several answers in the step of the blow (52000 sweeps of the same problem),
/// and which one is found depends on everything.
Scene hit_stacks(int count) {
  Scene scene = stacks(count);
  BodySpec stone = cube("stone", 0.06, 0.5, Vec3(0.02, 0.01, 0.3 + 0.03 + 0.5));
  stone.pose.rotation = Quat(Eigen::AngleAxisd(0.4, Vec3::UnitZ()));
  scene.bodies.push_back(stone);
  return scene;
}

}  // namespace

TEST_CASE("sleep: a stack left alone sleeps, keeps its contacts, and is not solved") {
  const Scene scene = stacks(2);
  Stepped on(scene);
  on.run(29);
  CHECK(on.sleepers() == 0);
  on.run(60);
  CHECK(on.sleepers() == 6);
  const StepMemory kept = on.memory;
  const MotionState frozen = on.state;
  for (int b = 0; b < 6; ++b)
    CHECK((on.state.velocity[b].isZero(0.0) && on.state.spin[b].isZero(0.0)));
  double weight = 0.0;
  for (size_t c = 0; c < kept.contacts.size(); ++c)
    if (kept.contacts[c].body_a == 6) weight += kept.impulses[c].z() / scene.step;
  CHECK(weight == Approx(2.0 * 3.3 * 9.81).epsilon(1e-3));
  for (int k = 0; k < 50; ++k) {
    const StepRecord record = on.step();
    CHECK(record.contacts == 0.0);
    CHECK(record.active_contacts > 0.0);
    CHECK(record.iterations == 0.0);
    CHECK(record.kinetic_energy == 0.0);
    CHECK(record.energy_residual == 0.0);
    if (k > 25) CHECK(on.stepper->detection_counters().manifolds == 0);  // not even looked at
  }
  CHECK(on.memory.impulses == kept.impulses);
  CHECK(largest_distance(on.state, frozen) == 0.0);

  Scene without = scene;
  without.sleep.enabled = false;
  Stepped off(without);
  off.run(29 + 60 + 50);
  CHECK(off.memory.rest.empty());
  CHECK(largest_distance(on.state, off.state) < 1e-6);
}

TEST_CASE(
    "sleep: what a falling stone touches wakes, the rest sleeps on, and momentum is as without "
    "sleep") {
  Scene scene = hit_stacks(2);
  scene.solver.tolerance = 1e-6;
  scene.solver.max_iterations = 100000;
  Scene without = scene;
  without.sleep.enabled = false;
  Stepped on(scene), off(without);
  int woken_at = -1;
  double residual = 0.0, momentum_error = 0.0, largest = 0.0;
  for (int k = 0; k < 400; ++k) {
    const bool slept = on.asleep(0);
    residual += std::abs(on.step().energy_residual);
    off.step();
    if (slept && !on.asleep(0) && woken_at < 0) woken_at = k;
    if (k > 100) CHECK((on.asleep(3) && on.asleep(4) && on.asleep(5)));
    CHECK(on.asleep(0) == on.asleep(2));
    if (k < 330) CHECK_FALSE(on.asleep(6));
    momentum_error = std::max(momentum_error, (on.momentum() - off.momentum()).norm());
    largest = std::max(largest, off.momentum().norm());
  }
  CHECK(woken_at > 300);
  CHECK(woken_at < 330);
  CHECK(on.sleepers() == 7);  // again, the stone on top
  CHECK(largest > 1.0);       // 0.5 kg at 3 m/s
  CHECK(momentum_error < 1e-6);
  CHECK(residual < 1e-9);
  CHECK(largest_distance(on.state, off.state) < 1e-7);
}

TEST_CASE("sleep: a checkpoint anywhere, read back, gives the same bits") {
  const TemporaryFolder folder;
  Stepped straight(hit_stacks(2)), stopped(hit_stacks(2));
  for (int k = 0; k < 400; ++k) {
    straight.step();
    if (k % 13 == 0) stopped.restart(folder.path() / "checkpoint.bin");
    stopped.step();
    if (k == 200) CHECK(straight.sleepers() == 6);
    if (k == 330) CHECK(straight.sleepers() == 3);
  }
  CHECK(straight.sleepers() == 7);
  check_same_bits(straight, stopped);
}

TEST_CASE("sleep: a wall that starts to move wakes what stands on it") {
  Scene scene = stacks(2);
  scene.walls[0].motion = WallMotion::prescribed;
  scene.walls[0].frequency = 5.0;
  Stepped on(scene);
  on.run(120);
  CHECK(on.sleepers() == 6);
  on.system.bodies[6].wall.amplitude = Vec3(0.02, 0.0, 0.0);
  on.step();
  CHECK(on.sleepers() == 0);
  on.run(200);  // two seconds' worth of turning points: at rest for no island that is carried
  CHECK(on.sleepers() == 0);
}

TEST_CASE(
    "sleep: a wall that comes from afar wakes what it reaches, and pushes it as without sleep") {
  Scene scene = stacks(1);
  scene.bodies.resize(1);
  WallSpec paddle;
  paddle.name = "paddle";
  paddle.normal = Vec3::UnitX();
  paddle.offset = -0.2;
  paddle.motion = WallMotion::prescribed;
  paddle.amplitude = Vec3(0.08, 0.0, 0.0);  // to -0.04: through where the lowest cube stands
  paddle.frequency = 1.0;
  scene.walls.push_back(paddle);
  Scene without = scene;
  without.sleep.enabled = false;
  Stepped on(scene), off(without);
  int asleep = 0;
  for (int k = 0; k < 500; ++k) {
    on.step();
    off.step();
    asleep += on.asleep(0);
  }
  CHECK(asleep > 200);
  CHECK(on.sleepers() == 0);
  CHECK(off.state.pose[0].position.x() > 0.005);
  CHECK(largest_distance(on.state, off.state) < 1e-6);
}

TEST_CASE("sleep: a force that changes wakes the whole stack") {
  Stepped on(stacks(2));
  on.run(120);
  REQUIRE(on.sleepers() == 6);
  on.system.bodies[2].force.constant = Vec3(0.0, 0.0, -1.0);
  on.step();
  CHECK(on.sleepers() == 3);
  CHECK((!on.asleep(0) && !on.asleep(1) && !on.asleep(2)));
  on.run(120);
  CHECK(on.sleepers() == 6);
  double weight = 0.0;
  for (size_t c = 0; c < on.memory.contacts.size(); ++c)
    if (on.memory.contacts[c].body_a == 6) weight += on.memory.impulses[c].z() / on.scene.step;
  CHECK(weight == Approx(2.0 * 3.3 * 9.81 + 1.0).epsilon(1e-3));
}

TEST_CASE(
    "sleep: not for what a varying force, a driven or a shaken wall acts on, nor for what stands "
    "on nothing") {
  Scene scene = stacks(1);
  SECTION("a varying force") {
    scene.bodies[0].force.amplitude = Vec3(1e-3, 0.0, 0.0);
    scene.bodies[0].force.frequency = 1.0;
  }
  SECTION("a shaken floor") {
    scene.walls[0].motion = WallMotion::prescribed;
    scene.walls[0].amplitude = Vec3(1e-6, 0.0, 0.0);
    scene.walls[0].frequency = 1.0;
  }
  SECTION("a driven wall on top") {
    WallSpec lid;
    lid.name = "lid";
    lid.normal = -Vec3::UnitZ();
    lid.offset = -0.3;
    lid.motion = WallMotion::driven;
    lid.mass = 1.0;
    lid.load.f_min = lid.load.f_max = 5.0;
    scene.walls.push_back(lid);
  }
  SECTION("a body held by a constant force drifts") {
    scene.bodies.resize(1);
    scene.bodies[0].pose.position.z() = 1.0;
    scene.bodies[0].velocity = Vec3(1e-5, 0.0, 0.0);
    scene.bodies[0].force.constant = -scene.bodies[0].mass * scene.gravity;
  }
  Stepped on(scene);
  for (int k = 0; k < 300; ++k) {
    on.step();
    CHECK(on.sleepers() == 0);
  }
}
