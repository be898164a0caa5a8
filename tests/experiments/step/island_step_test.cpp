// Islands solved one by one: on = off within the tolerance, one island with the same bits.

#include "problems/algebra/islands.hpp"
#include "tests/experiments/step/stacks.hpp"

using namespace ballast;

TEST_CASE("islands: a heap has the same bits whatever else is in the scene") {
  Scene alone = stacks(1), among = stacks(1);
  alone.sleep.enabled = among.sleep.enabled = false;
  alone.correction.enabled = among.correction.enabled =
      false;  // it does nothing while no point anywhere is too deep
  alone.bodies[2].velocity = among.bodies[2].velocity = Vec3(0.3, 0.1, 0.0);
  add_stack(among, 1.0, 0.0, 6);
  among.bodies[5].velocity = Vec3(0.0, 1.0, 0.0);
  Stepped a(alone), b(among);
  int several = 0;
  for (int k = 0; k < 150; ++k) {
    a.step();
    b.step();
    Islands islands;
    islands.find(b.stepper->problem());
    several += islands.count() > 1;
  }
  CHECK(several > 100);
  check_same_bits(a, b, 3);
}

TEST_CASE("islands: on = off within the tolerance, and each step meets it") {
  Scene scene = stacks(3);
  scene.sleep.enabled = false;
  for (int k : {0, 1, 2})
    scene.bodies[3 * k + 2].pose.position.z() += 2e-3 * (k + 1);  // fall one after the other
  add_stack(scene, 0.0, 1.0, 1);
  scene.bodies.back().velocity = Vec3(0.3, 0.2, 0.0);  // slides to a stop
  for (const double tolerance : {1e-4, 1e-7}) {
    scene.solver.tolerance = tolerance;
    scene.solver.islands = true;
    Stepped on(scene);
    scene.solver.islands = false;
    Stepped off(scene);
    const double limit = tolerance * step_settings(scene).velocity_scale();
    for (int k = 0; k < 150; ++k) {
      CHECK(on.step().error_rms <= limit);
      CHECK(off.step().error_rms <= limit);
    }
    CHECK((on.state.pose[9].position - scene.bodies[9].pose.position).norm() > 1e-3);
    CHECK(on.state.pose[8].position.z() < 0.2501);
    CHECK(largest_distance(on.state, off.state) <
          0.15 * limit * 10.0);  // an error of ten tolerances all the time
  }
}

TEST_CASE("islands: one island has the same bits on and off") {
  Scene scene = stacks(1);
  scene.sleep.enabled = false;
  scene.bodies[1].velocity = Vec3(0.3, 0.1, 0.0);
  Stepped on(scene);
  scene.solver.islands = false;
  Stepped off(scene);
  for (int k = 0; k < 100; ++k) CHECK(on.step().iterations == off.step().iterations);
  check_same_bits(on, off);
}
