#include "problems/mechanics/mechanical_system.hpp"

namespace ballast {
namespace {

Freedom freedom_of(const BodySpec& spec) {
  Freedom freedom;
  // The free directions in the order x, y, z: the first columns of `axes`.
  freedom.translations = 0;
  const bool free[3] = {spec.free_x, spec.free_y, spec.free_z};
  for (int axis = 0; axis < 3; ++axis)
    if (free[axis]) freedom.axes.col(freedom.translations++) = Vec3::Unit(axis);
  freedom.rotation = spec.free_rotation;
  return freedom;
}

}  // namespace

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

/// A wall has one coefficient for all its contacts; between bodies there is the scene's.
double MechanicalSystem::pair_friction(int a, int b) const {
  if (bodies[a].is_wall()) return bodies[a].wall_friction;
  if (bodies[b].is_wall()) return bodies[b].wall_friction;
  return friction;
}

void add_body(MechanicalSystem& system, MotionState& state, const BodySpec& spec, double volume) {
  RigidBody body;
  body.name = spec.name;
  body.mass = spec.mass;
  body.inertia = spec.inertia;
  body.volume = volume;
  body.freedom = freedom_of(spec);
  body.force = spec.force;
  body.shape.polyhedron = spec.shape.get();
  body.shape.fixed = body.freedom.count() == 0;
  system.shapes.push_back(spec.shape);
  system.bodies.push_back(std::move(body));
  system.grain_count = static_cast<int>(system.bodies.size());
  state.pose.push_back(spec.pose);
  state.velocity.push_back(spec.velocity);
  state.spin.push_back(spec.spin);
}

void add_wall(MechanicalSystem& system, MotionState& state, const WallSpec& spec) {
  RigidBody body;
  body.name = spec.name;
  body.wall = spec;
  body.wall_friction = spec.friction;
  body.freedom.translations = 0;
  body.freedom.rotation = false;
  if (spec.motion == WallMotion::driven) {
    // Its one unknown, the velocity along -normal, is positive outwards.
    body.mass = spec.mass;
    body.freedom.translations = 1;
    body.freedom.axes.col(0) = -spec.normal;
  }
  body.shape.plane.normal = spec.normal;
  body.shape.fixed = spec.motion != WallMotion::driven;
  system.bodies.push_back(std::move(body));
  Pose pose;
  pose.position = spec.offset * spec.normal;
  state.pose.push_back(pose);
  state.velocity.push_back(Vec3::Zero());
  state.spin.push_back(Vec3::Zero());
}

MechanicalSystem make_system(const Scene& scene, MotionState& state) {
  MechanicalSystem system;
  state = MotionState{};
  system.gravity = scene.gravity;
  system.friction = scene.friction;
  system.restitution = scene.restitution;
  // Bodies first, then walls: detection relies on that order.
  for (const BodySpec& body : scene.bodies) {
    double volume = 0.0;
    if (body.shape) volume = mass_properties(*body.shape).volume;
    add_body(system, state, body, volume);
  }
  for (const WallSpec& wall : scene.walls) add_wall(system, state, wall);
  return system;
}

std::vector<ContactShape> contact_shapes(const MechanicalSystem& system) {
  std::vector<ContactShape> shapes;
  shapes.reserve(system.bodies.size());
  for (const RigidBody& body : system.bodies) shapes.push_back(body.shape);
  return shapes;
}

/// m |v|^2 / 2 + w.I w / 2, spin and inertia in the body frame [J].
double kinetic_energy(const RigidBody& body, const Vec3& velocity, const Vec3& spin) {
  if (body.freedom.count() == 0) return 0.0;
  double energy = 0.5 * body.mass * velocity.squaredNorm();
  if (body.freedom.rotation) energy += 0.5 * spin.dot(body.inertia.cwiseProduct(spin));
  return energy;
}

/// How far the wall's plane has moved outwards, against its normal,
/// from its place in the scene [m].
double outward_displacement(const MechanicalSystem& system, const MotionState& state, int wall) {
  const WallSpec& spec = system.bodies[wall].wall;
  return spec.offset - spec.normal.dot(state.pose[wall].position);
}

double outward_velocity(const MechanicalSystem& system, const MotionState& state, int wall) {
  return -system.bodies[wall].wall.normal.dot(state.velocity[wall]);
}

}  // namespace ballast
