#pragma once
// Stacks of cubes being stepped, and what of two of them must be the same.

#include <algorithm>
#include <filesystem>

#include "experiments/record/checkpoint.hpp"
#include "experiments/step/time_step.hpp"
#include "tests/catch.hpp"
#include "tests/support/cube_scene.hpp"

namespace ballast {

inline constexpr double side = 0.1;  ///< of a cube [m]

/// Adds `count` cubes on the floor at (x, y), every other one turned and shifted a little.
inline void add_stack(Scene& scene, double x, double y, int count) {
  for (int k = 0; k < count; ++k) {
    BodySpec body = cube("", side, 1.0 + 0.1 * k, Vec3(x + 0.01 * (k % 2), y, (0.5 + k) * side));
    body.name = "cube_" + std::to_string(scene.bodies.size());
    body.pose.rotation = Quat(Eigen::AngleAxisd(0.3 * (k % 2), Vec3::UnitZ()));
    scene.bodies.push_back(body);
  }
}

inline Scene stacks(int count) {
  Scene scene = empty_scene();
  scene.walls.push_back(floor_at_zero(0.4));
  for (int k = 0; k < count; ++k) add_stack(scene, 0.5 * k, 0.0, 3);
  scene.solver.tolerance = 1e-4;
  scene.solver.max_iterations = 5000;
  scene.solver.islands = true;
  scene.sleep.enabled = true;
  scene.sleep.steps = 30;
  return scene;
}

/// A scene being stepped.
struct Stepped {
  explicit Stepped(const Scene& given) : scene(given), system(make_system(scene, state)) {
    stepper =
        std::make_unique<TimeStepper>(system, step_settings(scene), system.first_driven_wall());
  }
  StepRecord step() { return stepper->step(state, memory); }
  void run(int steps) {
    for (int k = 0; k < steps; ++k) step();
  }
  /// As a program does that is stopped and goes on: nothing but the checkpoint is left.
  void restart(const std::filesystem::path& file) {
    write_checkpoint(file, {"key", "drive", state, memory, {}});
    Checkpoint checkpoint = read_checkpoint(file);
    memory = checkpoint.memory;
    state = checkpoint.state;
    stepper =
        std::make_unique<TimeStepper>(system, step_settings(scene), system.first_driven_wall());
  }
  bool asleep(int body) const {
    return !memory.rest.empty() && memory.rest[body] == StepMemory::asleep;
  }
  int sleepers() const {
    return static_cast<int>(std::count(memory.rest.begin(), memory.rest.end(), StepMemory::asleep));
  }
  Vec3 momentum() const {
    Vec3 sum = Vec3::Zero();
    for (int b = 0; b < system.grain_count; ++b) sum += system.bodies[b].mass * state.velocity[b];
    return sum;
  }

  Scene scene;
  MotionState state;
  MechanicalSystem system;
  std::unique_ptr<TimeStepper> stepper;
  StepMemory memory;
};

inline double largest_distance(const MotionState& a, const MotionState& b) {
  double distance = 0.0;
  for (size_t k = 0; k < a.pose.size(); ++k)
    distance = std::max(distance, (a.pose[k].position - b.pose[k].position).norm());
  return distance;
}

inline void check_same_bits(const Stepped& a, const Stepped& b, int bodies) {
  for (int k = 0; k < bodies; ++k) {
    CHECK(a.state.pose[k].position == b.state.pose[k].position);
    CHECK(a.state.pose[k].rotation.coeffs() == b.state.pose[k].rotation.coeffs());
    CHECK(a.state.velocity[k] == b.state.velocity[k]);
    CHECK(a.state.spin[k] == b.state.spin[k]);
  }
}

/// Of the whole state, with contacts and impulses.
inline void check_same_bits(const Stepped& a, const Stepped& b) {
  check_same_bits(a, b, static_cast<int>(a.state.pose.size()));
  CHECK(a.memory.rest == b.memory.rest);
  CHECK(a.memory.impulses == b.memory.impulses);
  REQUIRE(a.memory.contacts.size() == b.memory.contacts.size());
  for (size_t c = 0; c < a.memory.contacts.size(); ++c) {
    const ContactPoint &p = a.memory.contacts[c], &q = b.memory.contacts[c];
    CHECK((p.body_a == q.body_a && p.body_b == q.body_b && p.feature == q.feature));
    CHECK((p.position == q.position && p.normal == q.normal && p.gap == q.gap));
  }
}

}  // namespace ballast
