#pragma once
// Pictures without a display: triangles into a picture with depths, and pictures into PNG files.

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "geometry/shape/pose.hpp"

namespace ballast {

/// What is seen at each point of a picture: which triangle's number, how far, 0 for nothing.
struct Raster {
  int width = 0, height = 0;
  std::vector<float> depth;  ///< of the nearest so far: growing away from the eye
  std::vector<std::uint32_t> owner;

  Raster(int wide, int high);
  size_t at(int x, int y) const {
    return static_cast<size_t>(y) * static_cast<size_t>(width) + static_cast<size_t>(x);
  }
  /// Corners: column and row of the picture [pixels], and what is linear in the picture and grows
  /// with the distance from the eye. `number` > 0.
  void triangle(const Vec3& a, const Vec3& b, const Vec3& c, std::uint32_t number);
};

/// Red, green and blue in linear light, 1 is white; row after row from the top.
struct Picture3 {
  int width = 0, height = 0;
  std::vector<std::array<float, 3>> pixels;
  size_t at(int x, int y) const {
    return static_cast<size_t>(y) * static_cast<size_t>(width) + static_cast<size_t>(x);
  }
};

/// As an 8-bit sRGB PNG. `shrink`: so many rows and columns become one.
std::string png_of(const Picture3& picture, int shrink = 1);

}  // namespace ballast
