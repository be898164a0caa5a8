#include "experiments/view/raster.hpp"

#include <limits>

#include "platform/deflate.hpp"

namespace ballast {
namespace {

std::uint8_t srgb_byte(float linear) {
  const float c = std::clamp(linear, 0.0f, 1.0f);
  const float encoded = c <= 0.0031308f ? 12.92f * c : 1.055f * std::pow(c, 1.0f / 2.4f) - 0.055f;
  return static_cast<std::uint8_t>(std::lround(255.0f * encoded));
}

}  // namespace

Raster::Raster(int wide, int high, bool with_owners)
    : width(wide),
      height(high),
      depth(static_cast<size_t>(wide) * static_cast<size_t>(high),
            std::numeric_limits<float>::infinity()),
      owner(with_owners ? depth.size() : 0, 0) {}

void Raster::triangle(const Vec3& a, const Vec3& b, const Vec3& c, std::uint32_t number) {
  scan_triangle(width, height, a, b, c, [&](int x, int y, float far) {
    const size_t here = at(x, y);
    if (far >= depth[here]) return;
    depth[here] = far;
    if (!owner.empty()) owner[here] = number;
  });
}

std::string srgb_bytes(const Picture3& picture, int shrink) {
  const int width = picture.width / shrink, height = picture.height / shrink;
  const float weight = 1.0f / static_cast<float>(shrink * shrink);
  std::string bytes;
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x)
      for (size_t k = 0; k < 3; ++k) {
        float sum = 0.0f;
        for (int j = 0; j < shrink; ++j)
          for (int i = 0; i < shrink; ++i)
            sum += picture.pixels[picture.at(x * shrink + i, y * shrink + j)][k];
        bytes += static_cast<char>(srgb_byte(weight * sum));
      }
  return bytes;
}

std::string png_of_bytes(const std::string& bytes, int width) {
  const auto row = 3 * static_cast<size_t>(width);
  std::string rows;
  for (size_t at = 0; at < bytes.size(); at += row)
    rows += '\0' + bytes.substr(at, row);  // no filter
  std::string png = png_head(width, static_cast<int>(bytes.size() / row), PngColour::truecolour);
  append_png_chunk(png, "IDAT", deflated(rows, 9));
  append_png_chunk(png, "IEND", "");
  return png;
}

std::string png_head(int width, int height, PngColour colour) {
  std::string header;
  append_png_number(header, static_cast<std::uint32_t>(width));
  append_png_number(header, static_cast<std::uint32_t>(height));
  header += {8, static_cast<char>(colour), 0, 0, 0};
  std::string png = "\x89PNG\r\n\x1a\n";
  append_png_chunk(png, "IHDR", header);
  return png;
}

void append_png_number(std::string& bytes, std::uint32_t value) {
  for (const int shift : {24, 16, 8, 0}) bytes += static_cast<char>(value >> shift & 255);
}

void append_png_chunk(std::string& png, const std::string& name, const std::string& content) {
  append_png_number(png, static_cast<std::uint32_t>(content.size()));
  png += name + content;
  append_png_number(png, crc32_of(name + content));
}

}  // namespace ballast
