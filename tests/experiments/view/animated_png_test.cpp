#include "experiments/view/animated_png.hpp"

#include "platform/deflate.hpp"
#include "tests/catch.hpp"
#include "tests/support/inflated.hpp"

namespace ballast {
namespace {

/// A picture of one colour with a dot of another.
Picture3 dotted(const std::array<float, 3>& ground, const std::array<float, 3>& dot, size_t place) {
  Picture3 picture{4, 3, {}};
  picture.pixels.assign(12, ground);
  picture.pixels[place] = dot;
  return picture;
}

std::uint32_t big_endian_at(const std::string& bytes, size_t at) {
  std::uint32_t value = 0;
  for (size_t k = 0; k < 4; ++k) value = value << 8 | static_cast<std::uint8_t>(bytes[at + k]);
  return value;
}

/// Names and contents of the chunks; every check sum holds.
std::vector<std::pair<std::string, std::string>> chunks_of(const std::string& png) {
  std::vector<std::pair<std::string, std::string>> chunks;
  for (size_t at = 8; at < png.size();) {
    const size_t size = big_endian_at(png, at);
    chunks.emplace_back(png.substr(at + 4, 4), png.substr(at + 8, size));
    CHECK(big_endian_at(png, at + 8 + size) == crc32_of(png.substr(at + 4, 4 + size)));
    at += 12 + size;
  }
  return chunks;
}

TEST_CASE("an animated PNG: frames are numbered as the format asks, and their pixels come back") {
  const std::array<float, 3> black{0, 0, 0}, white{1, 1, 1}, red{1, 0, 0};
  const std::vector<Picture3> pictures{dotted(white, red, 0), dotted(white, red, 5),
                                       dotted(black, red, 11)};
  const auto chunks = chunks_of(animated_png(pictures, 1, 300));
  std::string names;
  for (const auto& [name, content] : chunks) names += name + ' ';
  CHECK(names == "IHDR acTL PLTE fcTL IDAT fcTL fdAT fcTL fdAT IEND ");
  CHECK((big_endian_at(chunks[1].second, 0) == 3 && big_endian_at(chunks[1].second, 4) == 0));
  const std::string& palette = chunks[2].second;
  CHECK(palette.size() == 9);
  // sequence numbers run through fcTL and fdAT together
  CHECK((big_endian_at(chunks[3].second, 0) == 0 && big_endian_at(chunks[5].second, 0) == 1));
  CHECK((big_endian_at(chunks[6].second, 0) == 2 && big_endian_at(chunks[8].second, 0) == 4));
  CHECK(chunks[3].second.substr(20, 4) == std::string("\x01\x2c\x03\xe8", 4));
  for (size_t f = 0; f < 3; ++f) {
    const std::string& data = chunks[4 + 2 * f].second;
    const std::string rows = inflated(f == 0 ? data : data.substr(4));
    REQUIRE(rows.size() == 3 * 5);
    for (size_t p = 0; p < 12; ++p) {
      const auto colour = static_cast<size_t>(rows[p / 4 * 5 + 1 + p % 4]);
      for (size_t k = 0; k < 3; ++k)
        CHECK(static_cast<std::uint8_t>(palette[3 * colour + k]) ==
              std::lround(255.0f * pictures[f].pixels[p][k]));
    }
  }
  CHECK_THROWS_AS(animated_png({}, 1, 100), std::invalid_argument);
}

TEST_CASE(
    "a palette has no more colours than asked for, and all that there are where they are few") {
  std::string greys;
  for (int level = 0; level < 256; level += 8) greys += std::string(3, static_cast<char>(level));
  CHECK(palette_of({greys}, 256).size() == 32);
  const auto four = palette_of({greys}, 4);
  REQUIRE(four.size() == 4);
  // each stands for the eight around it
  std::vector<int> levels;
  for (const auto& colour : four) levels.push_back(colour[0]);
  std::sort(levels.begin(), levels.end());
  for (size_t k = 0; k < 4; ++k) CHECK(std::abs(levels[k] - int(28 + 64 * k)) <= 9);
}

}  // namespace
}  // namespace ballast
