// A wall pressed on a row of cubes: rigid when solved, elastic when not.

#include "experiments/measure/static_load.hpp"

#include "tests/catch.hpp"
#include "tests/support/cube_scene.hpp"

using namespace ballast;

namespace {

constexpr double side = 0.1, cube_mass = 2.0, load = 40.0;

/// `count` cubes in a row on a fixed wall, and a driven one on the last of them; no gravity.
Scene row_of_cubes(int count) {
  Scene scene = empty_scene();
  scene.gravity.setZero();
  scene.walls.push_back(floor_at_zero(0.0));
  for (int k = 0; k < count; ++k)
    scene.bodies.push_back(
        cube(("cube" + std::to_string(k)).c_str(), side, cube_mass, Vec3(0, 0, (k + 0.5) * side)));
  WallSpec lid;
  lid.name = "lid";
  lid.normal = -Vec3::UnitZ();
  lid.offset = -count * side;
  lid.motion = WallMotion::driven;
  lid.mass = 1.0;
  lid.load.f_min = lid.load.f_max = load;
  scene.walls.push_back(lid);
  scene.solver.name = "pgs";
  scene.solver.warm_start = true;
  scene.correction.enabled = false;
  return scene;
}

StaticLoad measured(Scene scene, double tolerance, int iterations, double seconds = 0.05) {
  scene.solver.tolerance = tolerance;
  scene.solver.max_iterations = iterations;
  MotionState state;
  const MechanicalSystem system = make_system(scene, state);
  return static_load(system, step_settings(scene), state, {},
                     {.force = load, .part = 0.2, .settle = seconds, .seconds = seconds});
}

}  // namespace

TEST_CASE("a row of rigid cubes, solved exactly, does not give way under a static load") {
  const StaticLoad rigid = measured(row_of_cubes(4), 1e-12, 100000);
  CHECK(std::abs(rigid.compliance) < 1e-12);
  CHECK(rigid.speed < 1e-9);
  CHECK(rigid.error <= 1e-12);
  CHECK(rigid.iterations >= 1.0);
}

TEST_CASE("few sweeps leave the row elastic, more of them less so") {
  const StaticLoad two = measured(row_of_cubes(4), 0.0, 2, 0.004),
                   many = measured(row_of_cubes(4), 0.0, 32, 0.004);
  CHECK(two.iterations == 2.0);
  CHECK(two.compliance > 0.0);
  CHECK(two.compliance > 2.0 * many.compliance);
  CHECK(two.speed > many.speed);
}

TEST_CASE("a static load that nothing holds accelerates the wall: Newton's law") {
  Scene scene = row_of_cubes(1);
  scene.bodies.clear();
  scene.walls.erase(scene.walls.begin());
  const double h = scene.step, n = 10.0;
  const StaticLoad free = measured(scene, 0.0, 1, n * h);
  // v = -(F/m_w) k h after step k; mean of steps 6 to 10
  CHECK(free.creep == Approx(-load * 8.0 * h));
  CHECK(free.speed == Approx(load * 8.0 * h));
}

TEST_CASE("without a driven wall there is no static load") {
  Scene scene = row_of_cubes(1);
  scene.walls.pop_back();
  CHECK_THROWS_AS(measured(scene, 0.0, 1), std::invalid_argument);
}
