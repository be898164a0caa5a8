#pragma once
// The faces of a solid as lists of its vertices, as a mesh is given.

#include <vector>

#include "geometry/shape/polyhedron.hpp"

namespace ballast {

inline std::vector<std::vector<int>> loops_of(const Polyhedron& solid) {
  std::vector<std::vector<int>> loops;
  for (int f = 0; f < solid.face_count(); ++f)
    loops.emplace_back(solid.face(f).begin(), solid.face(f).end());
  return loops;
}

}  // namespace ballast
