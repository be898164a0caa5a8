#pragma once
// The shapes that contact detection knows: polyhedra and planes.

#include "geometry/shape/polyhedron.hpp"

namespace ballast {

/// The half-space {x : normal.x >= 0} in the body frame of a wall; the wall's pose places it.
/// normal points into the free side, where the grains are.
struct Plane {
  Vec3 normal = Vec3::UnitZ();
};

/// A body as detection sees it: a polyhedron (in its body frame) or a plane.
struct ContactShape {
  const Polyhedron* polyhedron = nullptr;  ///< not owned; null for a plane
  Plane plane;                             ///< used when polyhedron is null
  bool fixed = false;  ///< never moves and carries no unknown: two fixed bodies are never a pair
};

}  // namespace ballast
