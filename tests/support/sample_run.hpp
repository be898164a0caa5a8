#pragma once
// A small system and made-up rows for tests of records and exports, without any dynamics.

#include <bit>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <limits>
#include <sstream>

#include "experiments/record/checkpoint.hpp"
#include "experiments/record/recorder.hpp"
#include "geometry/shape/grain_shapes.hpp"
#include "geometry/shape/pose.hpp"
#include "platform/error.hpp"
#include "tests/catch.hpp"
#include "tests/support/temporary_folder.hpp"

namespace ballast {

inline std::string file_bytes(const std::filesystem::path& file) {
  std::ifstream in(file, std::ios::binary);
  REQUIRE(in);
  std::stringstream text;
  text << in.rdbuf();
  return text.str();
}

/// Writes a new file: some file systems are a thousand times slower in overwriting a file safely.
inline void put_bytes(const std::filesystem::path& file, std::string_view bytes) {
  std::filesystem::remove(file);
  std::ofstream(file, std::ios::binary) << bytes;
}

/// The message of the Error that `action` throws. Fails the test if it throws none.
template <class Action>
std::string run_error(Action&& action) {
  try {
    action();
  } catch (const Error& error) {
    return error.what();
  }
  FAIL("no Error was thrown");
  return {};
}

using Catch::Matchers::Contains;

/// Three grains (two of one shape) and a square box of six walls from (0, 0, 0) to (0.6, 0.6, 0.5),
/// of which x_max is driven.
inline MechanicalSystem sample_system() {
  MechanicalSystem system;
  system.friction = 0.4;
  for (int k = 0; k < 2; ++k) {
    const PrincipalShape shape = make_grain({}, 0.05, 20 + k);
    system.shapes.push_back(std::make_shared<const Polyhedron>(shape.shape));
    for (int copy = 0; copy <= k; ++copy) {
      RigidBody body;
      body.name = "grain " + std::to_string(system.bodies.size());
      body.shape.polyhedron = system.shapes.back().get();
      body.volume = shape.volume;
      body.mass = 2700.0 * shape.volume;
      body.inertia = 2700.0 * shape.inertia;
      system.bodies.push_back(body);
    }
  }
  system.grain_count = 3;
  const char* names[] = {"floor", "lid", "x_min", "x_max", "y_min", "y_max"};
  const Vec3 normals[] = {Vec3::UnitZ(),  -Vec3::UnitZ(), Vec3::UnitX(),
                          -Vec3::UnitX(), Vec3::UnitY(),  -Vec3::UnitY()};
  for (int w = 0; w < 6; ++w) {
    RigidBody wall;
    wall.name = names[w];
    wall.shape.plane.normal = normals[w];
    if (w == 3) wall.mass = 107.0;
    system.bodies.push_back(wall);
  }
  return system;
}

/// Positions in the box, walls at their places; all else is random. Depends on `step` alone.
inline MotionState sample_state(const MechanicalSystem& system, long step) {
  Random random(1000 + static_cast<std::uint64_t>(step));
  MotionState state;
  state.step = step;
  state.time = 2e-4 * static_cast<double>(step);
  const double offsets[] = {0.0, -0.5, 0.0, -0.6, 0.0, -0.6};
  for (size_t b = 0; b < system.bodies.size(); ++b) {
    Pose pose;
    const bool wall = system.bodies[b].is_wall();
    if (wall) {
      pose.position = offsets[b - 3] * system.bodies[b].shape.plane.normal;
    } else {
      const double x = random.uniform(0.1, 0.5), y = random.uniform(0.1, 0.5),
                   z = random.uniform(0.1, 0.4);
      pose = {Vec3(x, y, z), random_rotation(random)};
    }
    state.pose.push_back(pose);
    state.velocity.push_back(wall ? Vec3::Zero()
                                  : Vec3(random.uniform(0.1, 1.0) * random_direction(random)));
    state.spin.push_back(wall ? Vec3::Zero()
                              : Vec3(random.uniform(1.0, 9.0) * random_direction(random)));
  }
  return state;
}

/// A row with different values in every column, among them numbers that text formats easily lose.
inline StepRecord sample_row(long step) {
  Random random(5000 + static_cast<std::uint64_t>(step));
  StepRecord row;
  for (const StepColumn& column : step_columns())
    row.*column.value = random.uniform(-1, 1) * std::exp(random.uniform(-40, 40));
  row.wall_v = -0.0;
  row.error_rms = std::numeric_limits<double>::denorm_min();
  row.error_max = std::numeric_limits<double>::max();
  row.time = 2e-4 * static_cast<double>(step);
  return row;
}

inline bool same_bits(double a, double b) {
  return std::bit_cast<std::uint64_t>(a) == std::bit_cast<std::uint64_t>(b);
}
inline bool same_bits(const Vec3& a, const Vec3& b) {
  return same_bits(a.x(), b.x()) && same_bits(a.y(), b.y()) && same_bits(a.z(), b.z());
}
inline bool same_bits(const Pose& a, const Pose& b) {
  const Quat &p = a.rotation, &q = b.rotation;
  return same_bits(a.position, b.position) && same_bits(p.w(), q.w()) && same_bits(p.x(), q.x()) &&
         same_bits(p.y(), q.y()) && same_bits(p.z(), q.z());
}
inline bool same_bits(const StepRecord& a, const StepRecord& b) {
  for (const StepColumn& column : step_columns())
    if (!same_bits(a.*column.value, b.*column.value)) return false;
  return true;
}
inline bool same_bits(const ContactPoint& a, const ContactPoint& b) {
  return a.body_a == b.body_a && a.body_b == b.body_b && a.feature == b.feature &&
         same_bits(a.normal, b.normal) && same_bits(a.position, b.position) &&
         same_bits(a.gap, b.gap);
}
template <class Value>
bool same_bits(const std::vector<Value>& a, const std::vector<Value>& b) {
  if (a.size() != b.size()) return false;
  for (size_t k = 0; k < a.size(); ++k)
    if (!same_bits(a[k], b[k])) return false;
  return true;
}
inline bool same_bits(const MotionState& a, const MotionState& b) {
  return a.step == b.step && same_bits(a.time, b.time) && same_bits(a.pose, b.pose) &&
         same_bits(a.velocity, b.velocity) && same_bits(a.spin, b.spin);
}
inline bool same_bits(const Checkpoint& a, const Checkpoint& b) {
  const DepositState &p = a.deposit, &q = b.deposit;
  return a.key == b.key && a.phase == b.phase && same_bits(a.state, b.state) &&
         same_bits(a.memory.contacts, b.memory.contacts) &&
         same_bits(a.memory.impulses, b.memory.impulses) && same_bits(p.lid, q.lid) &&
         same_bits(p.top, q.top) && same_bits(p.rain_time, q.rain_time) &&
         same_bits(p.rest_velocity, q.rest_velocity);
}

}  // namespace ballast
