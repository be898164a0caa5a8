#include "experiments/step/overlap_correction.hpp"

#include "experiments/step/time_step.hpp"
#include "tests/catch.hpp"
#include "tests/support/cube_scene.hpp"

using namespace ballast;

namespace {

constexpr double h = 1e-3;        // [s]
constexpr double overlap = 1e-4;  // [m]

/// Cubes of 1 and 3 kg, one above the other, that overlap with one contact between their centres.
struct TwoCubes {
  explicit TwoCubes(bool lower_is_fixed = false) {
    Scene scene = empty_scene();
    scene.bodies = {cube("lower", 0.1, 1.0, Vec3(0, 0, 0.05)),
                    cube("upper", 0.1, 3.0, Vec3(0, 0, 0.15 - overlap))};
    if (lower_is_fixed) {
      BodySpec& lower = scene.bodies[0];
      lower.free.fill(false);
      lower.free_rotation = false;
    }
    system = make_system(scene, state);
    contacts = {{0, 1, 0, Vec3::UnitZ(), Vec3(0, 0, 0.1 - overlap / 2), -overlap}};
  }
  /// Corrects one step, with the velocities of the state. Returns the potential energy given [J].
  double correct(const CorrectionSpec& spec) {
    ProblemAssembler assembler(system);
    Eigen::VectorXd v;
    assembler.pack(state, v);
    assembler.assemble({state, contacts, v, h, h});
    OverlapCorrection correction(system, spec);
    correction.find_targets(/*team=*/nullptr, assembler, contacts, v, h);
    return correction.apply(assembler, state);
  }
  double rise(size_t cube) const {
    return state.pose[cube].position.z() - (cube == 0 ? 0.05 : 0.15 - overlap);
  }

  MechanicalSystem system;
  MotionState state;
  std::vector<ContactPoint> contacts;
};

}  // namespace

TEST_CASE("two cubes part by the fraction of their overlap, each inversely to its mass") {
  TwoCubes cubes;
  CorrectionSpec spec;
  spec.slop = 1e-5;
  spec.fraction = 0.4;
  const double potential = cubes.correct(spec);
  const double parted = 0.4 * (overlap - 1e-5);
  CHECK(cubes.rise(0) == Approx(-0.75 * parted).epsilon(1e-9));
  CHECK(cubes.rise(1) == Approx(0.25 * parted).epsilon(1e-9));
  CHECK(std::abs(potential) < 1e-15);  // the centre of mass stays in place
}

TEST_CASE("over a fixed cube all of it is lifted, against gravity") {
  TwoCubes cubes(true);
  CorrectionSpec spec;
  spec.fraction = 1.0;
  const double potential = cubes.correct(spec);
  CHECK(cubes.rise(0) == 0.0);
  CHECK(cubes.rise(1) == Approx(overlap - spec.slop).epsilon(1e-9));
  CHECK(potential == Approx(3.0 * 9.81 * cubes.rise(1)).epsilon(1e-9));
}

TEST_CASE(
    "the overlap at the end of the step counts: cubes that part by themselves are left alone") {
  TwoCubes cubes;
  cubes.state.velocity[1] = Vec3(0, 0, 2 * overlap / h);
  cubes.correct(CorrectionSpec{});
  CHECK((cubes.rise(0) == 0.0 && cubes.rise(1) == 0.0));
  cubes.state.velocity[1] *= -1.0;
  CorrectionSpec spec;
  spec.fraction = 1.0;
  cubes.correct(spec);
  CHECK(cubes.rise(1) - cubes.rise(0) == Approx(3 * overlap - spec.slop).epsilon(1e-9));
}

TEST_CASE("nothing moves where the correction is off, or the overlap is within the slop") {
  TwoCubes cubes;
  CorrectionSpec spec;
  spec.enabled = false;
  CHECK(cubes.correct(spec) == 0.0);
  spec.enabled = true;
  spec.slop = 1.01 * overlap;
  CHECK(cubes.correct(spec) == 0.0);
  CHECK((cubes.rise(0) == 0.0 && cubes.rise(1) == 0.0));
}

TEST_CASE("the overlap correction lifts a sunken cube without giving it velocity") {
  Scene scene = empty_scene();
  scene.walls.push_back(floor_at_zero(0.4));
  scene.bodies.push_back(cube("body", 0.1, 2.0, Vec3(0, 0, 0.05 - 1e-4)));
  scene.correction.sweeps = 50;
  scene.solver.tolerance = 1e-6;
  scene.solver.max_iterations = 5000;
  const double slop = scene.correction.slop;
  for (const bool on : {true, false}) {
    scene.correction.enabled = on;
    MotionState state;
    const MechanicalSystem system = make_system(scene, state);
    TimeStepper stepper(system, scene, -1);
    StepMemory memory;
    double speed = 0.0, lifted = 0.0;
    for (int k = 0; k < 100; ++k) {
      lifted += stepper.step(state, memory).work_correction;
      speed = std::max(speed, state.velocity[0].norm());
    }
    CHECK(speed < 1e-6);
    const double expected = on ? -slop : -1e-4;
    CHECK(state.pose[0].position.z() - 0.05 == Approx(expected).margin(0.05 * slop));
    CHECK(lifted == Approx(2.0 * 9.81 * (on ? 1e-4 - slop : 0.0)).margin(1e-6));
  }
}

TEST_CASE("on a floor that is moved the correction is that of the floor at rest") {
  for (const double speed : {-0.1, 0.0, 0.1}) {
    Scene scene = empty_scene();
    ImposedMotion motion;
    motion.shift.rate = Vec3(0, 0, speed);
    scene.walls.push_back(moved_floor(0.4, motion));
    scene.bodies.push_back(cube("body", 0.1, 2.0, Vec3(0, 0, 0.05 - overlap)));
    scene.bodies.back().velocity = Vec3(0, 0, speed);
    scene.solver.tolerance = 1e-9;
    scene.solver.max_iterations = 5000;
    MotionState state;
    const MechanicalSystem system = make_system(scene, state);
    TimeStepper stepper(system, scene, -1);
    StepMemory memory;
    for (int k = 0; k < 100; ++k) stepper.step(state, memory);
    const double floor = speed * state.time;
    INFO("floor's speed " << speed);
    CHECK(state.velocity[0].z() == Approx(speed).margin(1e-5));
    CHECK(state.pose[0].position.z() - 0.05 - floor ==
          Approx(-scene.correction.slop).margin(0.5 * scene.correction.slop));
  }
}

TEST_CASE("the overlap correction does not move a driven wall") {
  Scene scene = empty_scene();
  scene.gravity.setZero();
  WallSpec wall = floor_at_zero(0.0);
  wall.motion = WallMotion::driven;
  wall.mass = 1.0;
  scene.walls.push_back(wall);
  scene.bodies.push_back(cube("body", 0.1, 2.0, Vec3(0, 0, 0.05 - 1e-4)));
  MotionState state;
  const MechanicalSystem system = make_system(scene, state);
  TimeStepper stepper(system, scene, 1);
  StepMemory memory;
  for (int k = 0; k < 100; ++k) stepper.step(state, memory);
  CHECK(outward_displacement(system, state, 1) == 0.0);
  CHECK(state.pose[0].position.z() > 0.05 - 0.5e-4);
}
