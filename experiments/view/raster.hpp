#pragma once
// Pictures without a display: triangles into a picture with depths, and pictures into PNG files.

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <string>
#include <vector>

#include "geometry/shape/pose.hpp"

namespace ballast {

/// Calls visit(column, row, depth) for each pixel whose middle a triangle covers. Corners: column
/// and row of the picture [pixels], and what is linear in the picture and grows with the distance
/// from the eye.
template <class Visit>
void scan_triangle(int width, int height, const Vec3& a, const Vec3& b, const Vec3& c,
                   Visit&& visit) {
  const double area = (b.x() - a.x()) * (c.y() - a.y()) - (b.y() - a.y()) * (c.x() - a.x());
  if (std::abs(area) < 1e-12) return;
  const auto [least_x, most_x] = std::minmax({a.x(), b.x(), c.x()});
  const auto [least_y, most_y] = std::minmax({a.y(), b.y(), c.y()});
  const int x0 = std::max(0, static_cast<int>(std::ceil(least_x - 0.5))),
            x1 = std::min(width - 1, static_cast<int>(std::floor(most_x - 0.5))),
            y0 = std::max(0, static_cast<int>(std::ceil(least_y - 0.5))),
            y1 = std::min(height - 1, static_cast<int>(std::floor(most_y - 0.5)));
  // where a pixel's middle is, in shares of the corners
  for (int y = y0; y <= y1; ++y)
    for (int x = x0; x <= x1; ++x) {
      const double px = x + 0.5, py = y + 0.5;
      const double u = ((b.x() - px) * (c.y() - py) - (b.y() - py) * (c.x() - px)) / area;
      const double v = ((c.x() - px) * (a.y() - py) - (c.y() - py) * (a.x() - px)) / area;
      const double w = 1.0 - u - v;
      if (u >= 0.0 && v >= 0.0 && w >= 0.0)
        visit(x, y, static_cast<float>(u * a.z() + v * b.z() + w * c.z()));
    }
}

/// What is seen at each point of a picture: which triangle's number, how far, 0 for nothing.
struct Raster {
  int width = 0, height = 0;
  std::vector<float> depth;          ///< of the nearest so far: growing away from the eye
  std::vector<std::uint32_t> owner;  ///< empty: only depths are asked for

  Raster(int wide, int high, bool with_owners = true);
  size_t at(int x, int y) const {
    return static_cast<size_t>(y) * static_cast<size_t>(width) + static_cast<size_t>(x);
  }
  /// Corners as for scan_triangle. `number` > 0.
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

/// Red, green and blue as sRGB bytes, pixel after pixel. `shrink`: so many rows and columns become
/// one.
std::string srgb_bytes(const Picture3& picture, int shrink);
/// As an 8-bit PNG: rows of `width` pixels that srgb_bytes() has given.
std::string png_of_bytes(const std::string& bytes, int width);

/// The beginning of a PNG: "truecolour" or "palette" with 8 bits.
enum class PngColour : char { truecolour = 2, palette = 3 };
std::string png_head(int width, int height, PngColour colour);
/// Most significant byte first, as PNG has its numbers.
void append_png_number(std::string& bytes, std::uint32_t value);
/// Length, name, content, check sum.
void append_png_chunk(std::string& png, const std::string& name, const std::string& content);

}  // namespace ballast
