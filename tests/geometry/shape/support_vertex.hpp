#pragma once
// The support function of a polyhedron by definition.

#include "geometry/shape/polyhedron.hpp"

namespace ballast {

/// Returns the vertex with the largest d.x (the first among equals), without any shortcut.
inline const Vec3& support_vertex(const Polyhedron& polyhedron, const Vec3& d) {
  const Vec3* best = &polyhedron.vertex(0);
  for (const Vec3& p : polyhedron.vertices())
    if (d.dot(p) > d.dot(*best)) best = &p;
  return *best;
}

}  // namespace ballast
