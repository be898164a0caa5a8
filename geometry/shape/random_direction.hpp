#pragma once
// Directions and rotations by the seeded generator: products and square roots only, so that they
// too are the same on every machine.

#include <cmath>

#include "geometry/shape/pose.hpp"
#include "platform/random.hpp"

namespace ballast {

/// A unit vector, uniform on the sphere (rejection from the cube).
inline Vec3 random_direction(Random& random) {
  while (true) {
    const double x = random.uniform(-1.0, 1.0), y = random.uniform(-1.0, 1.0),
                 z = random.uniform(-1.0, 1.0);
    const double length_sq = x * x + y * y + z * z;
    if (length_sq <= 1.0 && length_sq > 1e-6) return Vec3(x, y, z) / std::sqrt(length_sq);
  }
}

/// Uniform over rotations (rejection in four dimensions).
inline Quat random_rotation(Random& random) {
  while (true) {
    const double w = random.uniform(-1.0, 1.0), x = random.uniform(-1.0, 1.0),
                 y = random.uniform(-1.0, 1.0), z = random.uniform(-1.0, 1.0);
    const double length_sq = w * w + x * x + y * y + z * z;
    if (length_sq > 1.0 || length_sq < 1e-6) continue;
    const double length = std::sqrt(length_sq);
    return Quat(w / length, x / length, y / length, z / length);
  }
}

}  // namespace ballast
