#include "experiments/view/raster.hpp"

#include <cmath>

#include "platform/deflate.hpp"
#include "tests/catch.hpp"
#include "tests/support/inflated.hpp"

namespace ballast {
namespace {

std::uint32_t number_at(const std::string& bytes, size_t at) {
  std::uint32_t value = 0;
  for (size_t k = 0; k < 4; ++k) value = value << 8 | static_cast<unsigned char>(bytes[at + k]);
  return value;
}

TEST_CASE("a triangle covers the pixels whose middles it holds, whichever way round it runs") {
  for (const bool turned : {false, true}) {
    Raster raster(8, 6);
    const Vec3 a(1, 1, 2), b(6, 1, 2), c(1, 5, 2);
    raster.triangle(a, turned ? c : b, turned ? b : c, 7);
    for (int y = 0; y < 6; ++y)
      for (int x = 0; x < 8; ++x) {
        const double px = x + 0.5, py = y + 0.5;
        const bool is_in = px >= 1 && py >= 1 && (px - 1) / 5 + (py - 1) / 4 <= 1;
        CHECK(raster.owner[raster.at(x, y)] == (is_in ? 7u : 0u));
      }
  }
}

TEST_CASE("what is nearer hides what is farther, in whatever order they come") {
  for (const int first : {1, 2}) {
    Raster raster(10, 10);
    for (const int number : {first, 3 - first}) {
      const double z = number == 1 ? 1.0 : 2.0;
      raster.triangle(Vec3(-9, -9, z), Vec3(30, -9, z), Vec3(-9, 30, z),
                      static_cast<std::uint32_t>(number));
    }
    for (const std::uint32_t owner : raster.owner) CHECK(owner == 1);
    for (const float depth : raster.depth) CHECK(std::abs(depth - 1.0f) < 1e-6f);
  }
}

TEST_CASE("a picture as PNG: its parts, their check sums, and its pixels in sRGB") {
  Picture3 picture{4, 2, std::vector<std::array<float, 3>>(8, {1.0f, 0.0f, 0.2140411f})};
  picture.pixels[0] = {0.0f, 0.0f, 0.0f};
  const std::string png = png_of_bytes(srgb_bytes(picture, 1), 4);
  CHECK(png.substr(0, 8) == "\x89PNG\r\n\x1a\n");
  std::string rows;
  std::vector<std::string> names;
  for (size_t at = 8; at < png.size();) {
    const size_t length = number_at(png, at);
    const std::string name = png.substr(at + 4, 4), content = png.substr(at + 8, length);
    names.push_back(name);
    CHECK(number_at(png, at + 8 + length) == crc32_of(name + content));
    if (name == "IHDR") CHECK((number_at(content, 0) == 4 && number_at(content, 4) == 2));
    if (name == "IDAT") rows = inflated(content);
    at += 12 + length;
  }
  CHECK(names == std::vector<std::string>{"IHDR", "IDAT", "IEND"});
  REQUIRE(rows.size() == 2 * (1 + 3 * 4));
  CHECK(rows.substr(0, 7) == std::string("\0\0\0\0\xff\0\x7f", 7));
  // two rows and columns as one: a quarter of the first is black
  const std::string half = png_of_bytes(srgb_bytes(picture, 2), 2);
  CHECK(number_at(half, 16) == 2);
  CHECK(number_at(half, 20) == 1);
}

}  // namespace
}  // namespace ballast
