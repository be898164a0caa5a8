#include "experiments/view/raster.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "platform/deflate.hpp"

namespace ballast {
namespace {

std::uint8_t srgb_byte(float linear) {
  const float c = std::clamp(linear, 0.0f, 1.0f);
  const float encoded = c <= 0.0031308f ? 12.92f * c : 1.055f * std::pow(c, 1.0f / 2.4f) - 0.055f;
  return static_cast<std::uint8_t>(std::lround(255.0f * encoded));
}

void append_number(std::string& bytes, std::uint32_t value) {
  for (const int shift : {24, 16, 8, 0}) bytes += static_cast<char>(value >> shift & 255);
}

/// Length, name, content, check sum.
void append_chunk(std::string& png, const std::string& name, const std::string& content) {
  append_number(png, static_cast<std::uint32_t>(content.size()));
  png += name + content;
  append_number(png, crc32_of(name + content));
}

}  // namespace

Raster::Raster(int wide, int high)
    : width(wide),
      height(high),
      depth(static_cast<size_t>(wide) * static_cast<size_t>(high),
            std::numeric_limits<float>::infinity()),
      owner(depth.size(), 0) {}

void Raster::triangle(const Vec3& a, const Vec3& b, const Vec3& c, std::uint32_t number) {
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
      if (u < 0.0 || v < 0.0 || w < 0.0) continue;
      const auto far = static_cast<float>(u * a.z() + v * b.z() + w * c.z());
      const size_t here = at(x, y);
      if (far >= depth[here]) continue;
      depth[here] = far;
      owner[here] = number;
    }
}

std::string png_of(const Picture3& picture, int shrink) {
  const int width = picture.width / shrink, height = picture.height / shrink;
  const float weight = 1.0f / static_cast<float>(shrink * shrink);
  std::string rows;
  for (int y = 0; y < height; ++y) {
    rows += '\0';  // no filter
    for (int x = 0; x < width; ++x)
      for (size_t k = 0; k < 3; ++k) {
        float sum = 0.0f;
        for (int j = 0; j < shrink; ++j)
          for (int i = 0; i < shrink; ++i)
            sum += picture.pixels[picture.at(x * shrink + i, y * shrink + j)][k];
        rows += static_cast<char>(srgb_byte(weight * sum));
      }
  }
  std::string header;
  append_number(header, static_cast<std::uint32_t>(width));
  append_number(header, static_cast<std::uint32_t>(height));
  header += std::string("\x08\x02\0\0\0", 5);  // 8 bits, RGB
  std::string png = "\x89PNG\r\n\x1a\n";
  append_chunk(png, "IHDR", header);
  append_chunk(png, "IDAT", deflated(rows, 9));
  append_chunk(png, "IEND", "");
  return png;
}

}  // namespace ballast
