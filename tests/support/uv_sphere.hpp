#pragma once
// The unit sphere as most programs make it: rings of triangles between two poles.

#include <cmath>
#include <numbers>
#include <vector>

#include "geometry/shape/pose.hpp"

namespace ballast {

struct UvSphere {
  std::vector<Vec3> vertices;           ///< the poles last
  std::vector<std::vector<int>> faces;  ///< triangles, outward
};

/// 2 (rings - 1) columns triangles. A ring's quadrilaterals are plane, each is two triangles.
inline UvSphere make_uv_sphere(int rings, int columns) {
  UvSphere sphere;
  for (int i = 1; i < rings; ++i)
    for (int j = 0; j < columns; ++j) {
      const double polar = i * std::numbers::pi / rings,
                   around = j * 2.0 * std::numbers::pi / columns;
      sphere.vertices.emplace_back(std::sin(polar) * std::cos(around),
                                   std::sin(polar) * std::sin(around), std::cos(polar));
    }
  const int north = static_cast<int>(sphere.vertices.size()), south = north + 1;
  sphere.vertices.insert(sphere.vertices.end(), {Vec3::UnitZ(), -Vec3::UnitZ()});
  const auto at = [&](int i, int j) { return i * columns + j % columns; };
  for (int j = 0; j < columns; ++j) {
    sphere.faces.push_back({north, at(0, j), at(0, j + 1)});
    for (int i = 0; i + 2 < rings; ++i) {
      sphere.faces.push_back({at(i, j), at(i + 1, j), at(i + 1, j + 1)});
      sphere.faces.push_back({at(i, j), at(i + 1, j + 1), at(i, j + 1)});
    }
    sphere.faces.push_back({south, at(rings - 2, j + 1), at(rings - 2, j)});
  }
  return sphere;
}

}  // namespace ballast
