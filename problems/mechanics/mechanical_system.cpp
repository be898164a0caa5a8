#include "problems/mechanics/mechanical_system.hpp"

#include <algorithm>
#include <numeric>
#include <stdexcept>

#include "platform/text.hpp"

namespace ballast {
namespace {

/// The sum over all parts [m^3]: overlaps count twice.
double volume_of(const BodySpec& spec) {
  if (spec.parts.empty()) return mass_properties(*spec.shape).volume;
  double volume = 0.0;
  for (const PlacedShape& part : spec.parts) volume += mass_properties(*part.shape).volume;
  return volume;
}

/// Makes the body added last follow the motion, starting from its pose.
void impose(const ImposedMotion& motion, MechanicalSystem& system, MotionState& state) {
  RigidBody& body = system.bodies.back();
  body.imposed =
      std::make_shared<RigidBody::Imposed>(RigidBody::Imposed{motion, state.pose.back()});
  body.freedom = {.translations = 0, .rotation = false};
  body.shape.fixed = true;
  follow(body, 0.0, state.pose.back(), state.velocity.back(), state.spin.back());
}

}  // namespace

void follow(const RigidBody& body, double time, Pose& pose, Vec3& velocity, Vec3& spin) {
  const ImposedMotion& motion = body.imposed->motion;
  pose = motion.pose_at(time, body.imposed->start);
  velocity = motion.velocity_at(time, pose.position);
  spin = pose.rotation.conjugate() * motion.spin_at(time);
}

double MechanicalSystem::highest_restitution() const {
  double highest = restitution;
  for (const auto& [materials, law] : material_laws) highest = std::max(highest, law.restitution);
  return highest;
}

double MechanicalSystem::mass_of_grains() const {
  double mass = 0.0;
  for (int b = 0; b < grain_count; ++b) mass += bodies[b].mass;
  return mass;
}

int MechanicalSystem::first_driven_wall() const {
  for (size_t b = 0; b < bodies.size(); ++b)
    if (bodies[b].is_wall() && bodies[b].wall.motion == WallMotion::driven)
      return static_cast<int>(b);
  return -1;
}

void add_body(MechanicalSystem& system, MotionState& state, const BodySpec& spec, double volume) {
  RigidBody body;
  body.name = spec.name;
  body.mass = spec.mass;
  body.inertia = spec.inertia;
  body.volume = volume;
  // The free directions in the order x, y, z: the first columns of `axes`.
  body.freedom.translations = 0;
  for (int axis = 0; axis < 3; ++axis)
    if (spec.free[axis]) body.freedom.axes.col(body.freedom.translations++) = Vec3::Unit(axis);
  body.freedom.rotation = spec.free_rotation;
  body.force = spec.force;
  body.shape.polyhedron = spec.shape.get();
  body.shape.fixed = body.freedom.count() == 0;
  body.material = spec.material;
  system.shapes.push_back(spec.shape);
  for (const PlacedShape& part : spec.parts) {
    body.shape.parts.push_back({part.shape.get(), part.pose});
    system.shapes.push_back(part.shape);
  }
  system.bodies.push_back(std::move(body));
  system.grain_count = static_cast<int>(system.bodies.size());
  state.pose.push_back(spec.pose);
  state.velocity.push_back(spec.velocity);
  state.spin.push_back(spec.spin);
  if (spec.imposed) impose(*spec.imposed, system, state);
}

void add_wall(MechanicalSystem& system, MotionState& state, const WallSpec& spec) {
  RigidBody body;
  body.name = spec.name;
  body.wall = spec;
  body.freedom = {.translations = 0, .rotation = false};
  if (spec.motion == WallMotion::driven) {
    // Its one unknown, the velocity along -normal, is positive outwards.
    body.mass = spec.mass;
    body.freedom.translations = 1;
    body.freedom.axes.col(0) = -spec.normal;
  }
  body.material = spec.material;
  body.shape.plane.normal = spec.normal;
  body.shape.fixed = spec.motion != WallMotion::driven;
  system.bodies.push_back(std::move(body));
  state.pose.push_back({spec.offset * spec.normal, Quat::Identity()});
  state.velocity.push_back(Vec3::Zero());
  state.spin.push_back(Vec3::Zero());
  if (spec.motion == WallMotion::prescribed) impose(*spec.imposed, system, state);
}

MechanicalSystem make_system(const Scene& scene, MotionState& state) {
  MechanicalSystem system;
  state = MotionState{};
  system.gravity = scene.gravity;
  system.friction = scene.friction;
  system.restitution = scene.restitution;
  system.period = scene.period;
  for (const MaterialPair& pair : scene.material_pairs)
    system.material_laws[std::minmax(pair.a, pair.b)] = {pair.friction, pair.restitution};
  // Bodies first, then walls: detection relies on that order.
  for (const BodySpec& body : scene.bodies) add_body(system, state, body, volume_of(body));
  for (Pose& pose : state.pose) pose.position = system.period.wrapped(pose.position);
  for (const WallSpec& wall : scene.walls) add_wall(system, state, wall);
  return system;
}

std::vector<ContactShape> contact_shapes(const MechanicalSystem& system) {
  std::vector<ContactShape> shapes;
  shapes.reserve(system.bodies.size());
  for (const RigidBody& body : system.bodies) shapes.push_back(body.shape);
  return shapes;
}

double outward_displacement(const MechanicalSystem& system, const MotionState& state, int wall) {
  const WallSpec& spec = system.bodies[wall].wall;
  return spec.offset - spec.normal.dot(state.pose[wall].position);
}

double outward_velocity(const MechanicalSystem& system, const MotionState& state, int wall) {
  return -system.bodies[wall].wall.normal.dot(state.velocity[wall]);
}

ControlVolume::ControlVolume(const Vec3& lo, const Vec3& hi) : lo_(lo), hi_(hi) {
  if ((lo.array() < hi.array()).all()) return;
  throw std::invalid_argument(
      printed("control volume: the margins leave nothing: from (%g %g %g) to (%g %g %g) m", lo.x(),
              lo.y(), lo.z(), hi.x(), hi.y(), hi.z()));
}

double ControlVolume::solid_fraction(const MechanicalSystem& system, const MotionState& state,
                                     WorkerTeam* team) {
  inside_.resize(static_cast<size_t>(system.grain_count));
  // Grains on the box's faces take nearly all the time and lie side by side: short ranges spread
  // them over the threads.
  run_each(team, system.grain_count, /*together=*/64, [&](int b) {
    thread_local BoxClipper clipper;
    const RigidBody& body = system.bodies[b];
    inside_[b] = clipper.volume(*body.shape.polyhedron, state.pose[b], lo_, hi_, body.volume);
  });
  // They are summed in order, whichever thread clipped them, so that the bits are the same.
  return std::accumulate(inside_.begin(), inside_.end(), 0.0) / volume();
}

}  // namespace ballast
