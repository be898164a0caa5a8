#pragma once
// From the world into a picture, and the colours that are drawn there.

#include <algorithm>
#include <array>
#include <cmath>

#include "geometry/shape/pose.hpp"

namespace ballast {

/// Red, green and blue in linear light, 1 is white.
using Colour = std::array<float, 3>;

/// Light at rest to dark at the top, as the page's ramp; `share` from 0 to 1.
inline Colour ramp_colour(double share) {
  constexpr Colour stops[] = {{0.79f, 0.72f, 0.58f}, {0.86f, 0.45f, 0.12f}, {0.80f, 0.17f, 0.05f},
                              {0.56f, 0.05f, 0.10f}, {0.23f, 0.03f, 0.19f}, {0.06f, 0.03f, 0.21f}};
  const double at = 5.0 * std::clamp(share, 0.0, 1.0);
  const auto k = std::min<size_t>(4, static_cast<size_t>(at));
  Colour colour;
  for (size_t i = 0; i < 3; ++i)
    colour[i] = stops[k][i] + (stops[k + 1][i] - stops[k][i]) * static_cast<float>(at - double(k));
  return colour;
}

/// A pinhole or, without a distance, a far one: world to column, row and depth.
struct Lens {
  Mat3 axes;  // rows: right, up, back
  Vec3 eye;
  double scale = 1.0, width = 0.0, height = 0.0;
  bool is_far = false;
  double above = 0.0;  ///< rows of the picture that are above what is drawn

  Vec3 operator*(const Vec3& p) const {
    const Vec3 seen = axes * (p - eye);
    const double w = is_far ? 1.0 : -seen.z();
    // 1/w is linear in the picture; turned round it grows with the distance
    return {0.5 * width + scale * seen.x() / w, 0.5 * height - above - scale * seen.y() / w,
            is_far ? -seen.z() : -1.0 / w};
  }
  /// How many pixels a length has at a depth that `*` has given.
  double pixels(double length, double depth) const {
    return is_far ? scale * length : -scale * length * depth;
  }
};

inline Mat3 axes_towards(const Vec3& back) {
  const Vec3 up = std::abs(back.z()) > 0.9999 ? Vec3::UnitY() : Vec3::UnitZ();
  Mat3 axes;
  axes.row(0) = up.cross(back).normalized();
  axes.row(2) = back;
  axes.row(1) = back.cross(Vec3(axes.row(0)));
  return axes;
}

}  // namespace ballast
