#pragma once
// Cubes over a floor, for tests of the step.

#include "problems/scene/scene.hpp"

namespace ballast {

inline BodySpec cube(const char* name, double side, double mass, const Vec3& position) {
  BodySpec body;
  body.name = name;
  body.shape = std::make_shared<const Polyhedron>(make_box(Vec3::Constant(side)));
  body.mass = mass;
  body.inertia = Vec3::Constant(mass * side * side / 6.0);
  body.pose.position = position;
  return body;
}

inline Scene empty_scene() {
  Scene scene;
  scene.name = "test";
  scene.step = 1e-3;
  return scene;
}

inline WallSpec floor_at_zero(double friction) {
  WallSpec wall;
  wall.name = "floor";
  wall.friction = friction;
  return wall;
}

inline WallSpec moved_floor(double friction, const ImposedMotion& motion) {
  WallSpec wall = floor_at_zero(friction);
  wall.motion = WallMotion::prescribed;
  wall.imposed = std::make_shared<const ImposedMotion>(motion);
  return wall;
}

}  // namespace ballast
