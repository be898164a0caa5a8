// The step itself: free flight, rotation, energy, the overlap correction.

#include "experiments/step/time_step.hpp"

#include <limits>
#include <numbers>

#include "tests/catch.hpp"
#include "tests/support/cube_scene.hpp"

using namespace ballast;

TEST_CASE("a force that closes a gap within a step is met by the floor") {
  Scene scene = empty_scene();
  scene.walls.push_back(floor_at_zero(0.4));
  scene.bodies.push_back(cube("pressed", 0.1, 1.0, Vec3(0, 0, 0.05 + 1e-3)));
  scene.bodies[0].force.constant = Vec3(0, 0, -1e4);
  MotionState state;
  const MechanicalSystem system = make_system(scene, state);
  TimeStepper stepper(system, scene, -1);
  StepMemory memory;
  stepper.step(state, memory);
  CHECK(stepper.problem().contact_count() > 0);
  CHECK(state.pose[0].position.z() > 0.05 - 1e-6);
}

TEST_CASE("a load that pushes a driven wall onto a body within a step is borne by the body") {
  Scene scene = empty_scene();
  WallSpec lid;
  lid.name = "lid";
  lid.normal = -Vec3::UnitZ();
  lid.offset = -(0.1 + 1e-3);  // a millimetre over the cube
  lid.motion = WallMotion::driven;
  lid.mass = 1.0;
  lid.load = {1e4, 1e4, 0.0};
  scene.walls = {floor_at_zero(0.4), lid};
  scene.bodies.push_back(cube("pressed", 0.1, 1.0, Vec3(0, 0, 0.05)));
  MotionState state;
  const MechanicalSystem system = make_system(scene, state);
  TimeStepper stepper(system, scene, 2);
  StepMemory memory;
  stepper.step(state, memory);
  CHECK(stepper.problem().contact_count() == 8);
  CHECK(outward_displacement(system, state, 2) > -1e-3 - 1e-6);
}

TEST_CASE("a floor that starts to move where a step ends does the work that the body has") {
  Scene scene = empty_scene();
  scene.gravity = Vec3::Zero();
  ImposedMotion kick;
  const Vec3 rest = Vec3::Zero();
  kick.shift.table = {{0.0, rest}, {0.01, rest}, {0.02, Vec3(0, 0, 0.01)}};
  scene.walls.push_back(moved_floor(0.4, kick));
  scene.bodies.push_back(cube("kicked", 0.1, 2.0, Vec3(0, 0, 0.05)));
  scene.solver.tolerance = 1e-9;
  MotionState state;
  const MechanicalSystem system = make_system(scene, state);
  TimeStepper stepper(system, scene, -1);
  StepMemory memory;
  double work = 0.0, dissipated = 0.0;
  while (state.step < 15) {
    const StepRecord record = stepper.step(state, memory);
    CHECK(record.dissipated > -1e-12);
    work += record.work_prescribed;
    dissipated += record.dissipated;
  }
  CHECK(state.velocity[0].z() == Approx(1.0).epsilon(1e-6));
  CHECK(work - dissipated == Approx(1.0).epsilon(1e-6));
}

TEST_CASE("a cube slides over the joints of a floor of fixed boxes as over one body") {
  constexpr double side = 0.2, v = 1.0, mu = 0.4, exact = v * v / (2 * mu * 9.81);
  for (const double heading : {0.0, 0.3, std::numbers::pi / 4})
    for (const double gap : {-1e-6, 0.0, 1e-6}) {
      Scene scene = empty_scene();
      scene.friction = mu;
      scene.solver.tolerance = 1e-6;
      const Vec3 ahead(std::cos(heading), std::sin(heading), 0.0);
      scene.bodies.push_back(cube("slides", 0.1, 1.0, Vec3(-0.05, -0.05, 0.05 + gap)));
      scene.bodies[0].velocity = v * ahead;
      for (int x = 0; x < 3; ++x)
        for (int y = 0; y < 3; ++y) {
          scene.bodies.push_back(cube("tile", side, 1.0, Vec3(side * x, side * y, -0.5 * side)));
          scene.bodies.back().free = {false, false, false};
          scene.bodies.back().free_rotation = false;
        }
      MotionState state;
      const MechanicalSystem system = make_system(scene, state);
      TimeStepper stepper(system, scene, -1);
      StepMemory memory;
      while (state.step < 400) stepper.step(state, memory);
      const Vec3 way = state.pose[0].position - Vec3(-0.05, -0.05, 0.05 + gap);
      INFO("heading " << heading << ", gap " << gap << ": " << way.transpose());
      CHECK(way.dot(ahead) == Approx(exact).epsilon(1e-3));
      CHECK(way.cross(ahead).norm() < 1e-5);
      CHECK(state.velocity[0].norm() < 1e-6);
    }
}

TEST_CASE(
    "what slides without friction over a joint that bends down, or rolls on, keeps its speed") {
  BodySpec ball = cube("passes", 0.1, 1.0, Vec3(-0.2, 0.003, 0.1));
  ball.shape = std::make_shared<const Polyhedron>(make_sphere(0.1, 2));
  for (const double degrees : {0.0, 1.0, 10.0, 45.0})
    for (const double ahead : {0.0, 0.0005, 0.00031}) {
      Scene scene = empty_scene();
      scene.friction = 0.0;
      scene.solver.tolerance = 1e-6;
      const Quat bend = rotation_by(degrees * std::numbers::pi / 180.0 * Vec3::UnitY());
      for (const double side : {-1.0, 1.0}) {
        BodySpec tile = cube("tile", 2.0, 1.0, Vec3(side, 0, -1));
        if (side > 0.0) tile.pose = {bend * tile.pose.position, bend};
        tile.free = {false, false, false};
        tile.free_rotation = false;
        scene.bodies.push_back(tile);
      }
      scene.bodies.push_back(degrees > 0.0 ? cube("passes", 0.1, 1.0, Vec3(-0.2, 0, 0.05)) : ball);
      scene.bodies.back().pose.position.x() -= ahead;
      scene.bodies.back().velocity = Vec3(2, 0, 0);
      MotionState state;
      const MechanicalSystem system = make_system(scene, state);
      TimeStepper stepper(system, scene, -1);
      StepMemory memory;
      while (state.step < 95) stepper.step(state, memory);
      INFO(degrees << " degrees, ahead " << ahead);
      CHECK((state.velocity[2] - Vec3(2, 0, 0)).norm() < 1e-6);
    }
}

TEST_CASE("no step is long enough to fly through a thin fixed plate") {
  for (const double steps_travel : {0.3, 0.8, 1.3, 2.9})
    for (const bool is_imposed : {false, true}) {
      Scene scene = empty_scene();
      scene.gravity.setZero();
      scene.step = 5e-3;
      BodySpec plate = cube("plate", 2.0, 1.0, Vec3(0, 0, -0.01));
      plate.shape = std::make_shared<const Polyhedron>(make_box(Vec3(2, 2, 0.02)));
      plate.free = {false, false, false};
      plate.free_rotation = false;
      if (is_imposed) plate.imposed = ImposedMotion{};
      BodySpec ball = cube("ball", 0.04, 1.0, Vec3(0.1, 0.13, 0.2));
      ball.shape = std::make_shared<const Polyhedron>(make_sphere(0.02, 1));
      ball.velocity = Vec3(0, 0, -steps_travel * 0.06 / scene.step);
      scene.bodies = {ball, plate};
      MotionState state;
      const MechanicalSystem system = make_system(scene, state);
      TimeStepper stepper(system, scene, -1);
      StepMemory memory;
      while (state.step < 40) CHECK(stepper.step(state, memory).penetration_max < 1e-9);
      INFO("travel of a step over both sizes: " << steps_travel);
      CHECK(state.pose[0].position.z() == Approx(0.02).margin(1e-3));
      CHECK(state.velocity[0].norm() < 1e-6);
    }
}

TEST_CASE("a cube that passes the corner of a fixed one in time does not feel it") {
  const Vec3 velocity(0.45, 0.34, 0);
  for (const bool is_in_time : {true, false})
    for (int phase = 0; phase < 8; ++phase) {
      Scene scene = empty_scene();
      scene.gravity.setZero();
      scene.bodies = {cube("passes", 0.1, 1.0, Vec3(-0.1503, 0, 0)),
                      cube("corner", 0.2, 1.0, Vec3::Zero())};
      BodySpec& passes = scene.bodies[0];
      passes.pose.position.y() = is_in_time ? 0.1499 : 0.1496;  // out after 0.3 or 1.2 ms, at 0.67
      passes.pose.position -= 0.25 * phase * scene.step * velocity;
      passes.velocity = velocity;
      scene.bodies[1].free = {false, false, false};
      scene.bodies[1].free_rotation = false;
      MotionState state;
      const MechanicalSystem system = make_system(scene, state);
      TimeStepper stepper(system, scene, -1);
      StepMemory memory;
      while (state.step < 8) stepper.step(state, memory);
      INFO("phase " << phase);
      CHECK(((state.velocity[0] - velocity).norm() < 1e-9) == is_in_time);
    }
}

TEST_CASE("a cube whose rim meets the edge of a fixed table turns as over a heavy free one") {
  const auto end_of = [](bool is_fixed) {
    Scene scene = empty_scene();
    scene.gravity.setZero();
    scene.friction = 0.0;
    BodySpec table = cube("table", 1.0, 1e9, Vec3(-0.5, 0, -0.5));
    table.free = {false, false, !is_fixed};
    table.free_rotation = false;
    scene.bodies = {cube("falls", 0.1, 1.0, Vec3(0.049, 0, 0.0737)), table};
    scene.bodies[0].velocity = Vec3(0, 0, -3);
    MotionState state;
    const MechanicalSystem system = make_system(scene, state);
    TimeStepper stepper(system, scene, -1);
    StepMemory memory;
    while (state.step < 12) stepper.step(state, memory);
    return state.spin[0].y();
  };
  CHECK(std::abs(end_of(true)) > 30.0);
  CHECK(end_of(true) == Approx(end_of(false)).epsilon(1e-3));
}

TEST_CASE("a belt of imposed bodies stays within its period, and takes along what lies on it") {
  Scene scene = empty_scene();
  scene.period.vector = Vec3(2, 0, 0);
  scene.bodies.push_back(cube("lies", 0.1, 1.0, Vec3(-0.3, 0, 0.05)));
  for (int k = 0; k < 5; ++k) {
    scene.bodies.push_back(cube("belt", 0.4, 1.0, Vec3(0.4 * k + 0.2, 0, -0.2)));
    scene.bodies.back().imposed = ImposedMotion{};
    scene.bodies.back().imposed->shift.rate = Vec3(-2, 0, 0);
  }
  scene.bodies[0].velocity = Vec3(-2, 0, 0);
  MotionState state;
  const MechanicalSystem system = make_system(scene, state);
  CHECK(state.pose[0].position.x() == Approx(1.7));
  TimeStepper stepper(system, scene, -1);
  StepMemory memory;
  while (state.step < 1500) {
    stepper.step(state, memory);
    for (const Pose& pose : state.pose)
      if (!(pose.position.x() >= 0.0 && pose.position.x() < 2.0)) FAIL("step " << state.step);
  }
  CHECK(state.velocity[0].x() == Approx(-2.0).epsilon(1e-6));
  CHECK(state.pose[0].position.x() == Approx(0.7).epsilon(1e-4));
}

TEST_CASE("a cube that sticks to a turning plate goes round, and leaves it where friction ends") {
  constexpr double radius = 0.2, mu = 0.4;
  const double limit = std::sqrt(mu * 9.81 / radius);
  const auto end_of = [&](double rate, double& dissipated) {
    Scene scene = empty_scene();
    scene.friction = mu;
    scene.solver.tolerance = 1e-9;
    BodySpec plate = cube("plate", 1.0, 1.0, Vec3(0, 0, -0.5));
    plate.imposed = ImposedMotion{};
    plate.imposed->centre = plate.pose.position;
    plate.imposed->turn.rate = rate;
    scene.bodies = {cube("goes along", 0.05, 1.0, Vec3(radius, 0, 0.025)), plate};
    scene.bodies[0].velocity = Vec3(0, rate * radius, 0);
    scene.bodies[0].spin = Vec3(0, 0, rate);
    MotionState state;
    const MechanicalSystem system = make_system(scene, state);
    TimeStepper stepper(system, scene, -1);
    StepMemory memory;
    while (state.step < 1000) dissipated += stepper.step(state, memory).dissipated;
    return state.pose[0].position;
  };
  double dissipated = 0.0;
  const Vec3 end = end_of(0.95 * limit, dissipated);
  CHECK(end.head<2>().norm() == Approx(radius).epsilon(1e-5));
  CHECK(std::remainder(std::atan2(end.y(), end.x()) - 0.95 * limit, 2.0 * std::numbers::pi) ==
        Approx(0.0).margin(1e-4));
  CHECK(std::abs(dissipated) < 1e-6);
  CHECK(end_of(1.05 * limit, dissipated).head<2>().norm() > 1.5 * radius);
}

TEST_CASE("a body that spins too fast for the step ends the run by its name") {
  Scene scene = empty_scene();
  scene.bodies.push_back(cube("top", 0.1, 2.0, Vec3(0, 0, 10)));
  scene.bodies[0].inertia = Vec3(1, 2, 2.5);
  scene.bodies[0].spin = Vec3(1e6, 2e6, 2e6);
  MotionState state;
  const MechanicalSystem system = make_system(scene, state);
  TimeStepper stepper(system, scene, -1);
  StepMemory memory;
  CHECK_THROWS_WITH(stepper.step(state, memory),
                    Catch::Contains("body 0 (top) turns by 3e+03 radians in a step") &&
                        Catch::Contains("scene.step"));
}

TEST_CASE("after a step that failed the next one starts without impulses") {
  Scene scene = empty_scene();
  scene.walls.push_back(floor_at_zero(0.4));
  scene.bodies.push_back(cube("resting", 0.1, 2.0, Vec3(0, 0, 0.05)));
  scene.bodies[0].inertia = Vec3(1, 2, 2.5);
  MotionState state;
  const MechanicalSystem system = make_system(scene, state);
  TimeStepper stepper(system, scene, -1);
  StepMemory memory;
  for (int k = 0; k < 3; ++k) stepper.step(state, memory);
  const MotionState good = state;
  Impulses start;
  stepper.step(state, memory);
  stepper.warm_start(memory, start);
  CHECK(start.norm() > 0.0);
  state.spin[0] = Vec3(1e6, 2e6, 2e6);
  CHECK_THROWS_AS(stepper.step(state, memory), Error);
  CHECK(memory.impulses.empty());  // those there were belong to other contacts
  state = good;
  stepper.step(state, memory);
  stepper.warm_start(memory, start);
  CHECK(start.size() > 0);
  CHECK(start.norm() == 0.0);
}

TEST_CASE("impulses that are not finite end the run by the solver's name, not later by a pose's") {
  SolverRun run;
  run.solved.impulses = Impulses::Ones(3);
  CHECK_NOTHROW(require_finite(run, "nncg", 0.373));
  run.solved.impulses[1] = std::numeric_limits<double>::quiet_NaN();
  run.solved.reason = StopReason::numerical_failure;
  CHECK_THROWS_WITH(require_finite(run, "nncg", 0.373), Catch::Contains("0.373 s") &&
                                                            Catch::Contains("solver.name = nncg") &&
                                                            Catch::Contains("numerical_failure"));
}

TEST_CASE("free fall is exact at every step") {
  Scene scene = empty_scene();
  scene.bodies.push_back(cube("body", 0.1, 2.0, Vec3(0, 0, 10)));
  scene.bodies[0].velocity = Vec3(1, -2, 3);
  scene.bodies[0].spin = Vec3(1, 2, 3);
  MotionState state;
  const MechanicalSystem system = make_system(scene, state);
  TimeStepper stepper(system, scene, -1);
  StepMemory memory;
  for (int k = 1; k <= 1000; ++k) {
    const StepRecord record = stepper.step(state, memory);
    CHECK(std::abs(record.energy_residual) < 1e-12);
  }
  const double t = 1.0;
  CHECK(
      (state.pose[0].position - (Vec3(0, 0, 10) + t * Vec3(1, -2, 3) + 0.5 * t * t * scene.gravity))
          .norm() < 1e-11);
  CHECK(std::abs(state.pose[0].rotation.norm() - 1.0) < 1e-15);
}

TEST_CASE(
    "a dropped cube comes to rest on the floor without sinking in, and the energy account closes") {
  Scene scene = empty_scene();
  scene.walls.push_back(floor_at_zero(0.4));
  scene.bodies.push_back(cube("body", 0.1, 2.0, Vec3(0, 0, 0.07)));
  scene.solver.tolerance = 1e-9;
  scene.solver.max_iterations = 5000;
  MotionState state;
  const MechanicalSystem system = make_system(scene, state);
  TimeStepper stepper(system, scene, -1);
  StepMemory memory;
  double kinetic = 0.0, dissipated = 0.0, gravity = 0.0, residual = 0.0, penetration = 0.0;
  for (int k = 0; k < 300; ++k) {
    const StepRecord record = stepper.step(state, memory);
    kinetic = record.kinetic_energy;
    dissipated += record.dissipated;
    gravity += record.work_gravity;
    residual += std::abs(record.energy_residual);
    penetration = std::max(penetration, record.penetration_max);
  }
  CHECK(std::abs(state.pose[0].position.z() - 0.05) < 1e-9);
  CHECK(kinetic < 1e-15);
  CHECK(gravity == Approx(2.0 * 9.81 * 0.02).epsilon(1e-6));
  CHECK(dissipated == Approx(gravity).epsilon(1e-6));
  CHECK(residual < 1e-12);
  CHECK(penetration < 1e-9);
}

TEST_CASE("LMGC90's rule stops the sweeps of a step at multiples of its looks") {
  Scene scene = empty_scene();
  scene.walls.push_back(floor_at_zero(0.4));
  scene.bodies.push_back(cube("below", 0.1, 2.0, Vec3(0, 0, 0.05)));
  scene.bodies.push_back(cube("above", 0.1, 2.0, Vec3(0.01, 0, 0.15)));
  scene.bodies[1].velocity = Vec3(0.5, 0.2, 0.0);
  scene.solver.name = "pgs";
  scene.solver.max_iterations = 5000;
  scene.solver.tolerance = 1e9;  // met at once
  scene.solver.change_tolerance = 1e-6;
  scene.solver.change_every = 10;
  MotionState state;
  const MechanicalSystem system = make_system(scene, state);
  TimeStepper stepper(system, scene, -1);
  StepMemory memory;
  for (int k = 0; k < 20; ++k) {
    const StepRecord record = stepper.step(state, memory);
    CHECK(record.contacts > 0);
    CHECK(record.iterations > 0);
    CHECK(std::lround(record.iterations) % 10 == 0);
    CHECK(record.error_rms <= 1e-4 * scene.gravity.norm() * scene.step);
  }
}
