#include "platform/pack.hpp"

#include <array>
#include <limits>
#include <vector>

#include <Eigen/Dense>

#include "tests/catch.hpp"

using namespace ballast;

namespace {

enum class Colour { red, green };

struct Sample {
  bool flag = false;
  Colour colour = Colour::red;
  long count = 0;
  std::string text;
  std::array<double, 3> corner{};
  std::vector<int> numbers;
  Eigen::VectorXd column;
  std::vector<Eigen::Vector3d> points;
};

template <class Carrier, class Of>
void carry(Carrier& carrier, Of& sample) {
  carrier.numbers(sample.flag, sample.colour, sample.count);
  carrier.text(sample.text);
  carrier.fixed(sample.corner);
  carrier.list(sample.numbers);
  carrier.list(sample.column);
  carrier.list(sample.points, [&](auto& point) { carrier.fixed(point); });
}

Sample sample() {
  Sample s{true, Colour::green, -7, std::string("a\0b", 3), {1.5, -0.0, 1e-310}, {3, -1}, {}, {}};
  s.column = Eigen::Vector2d(std::numeric_limits<double>::infinity(), 2.0);
  s.points = {{1, 2, 3}, {4, 5, 6}};
  return s;
}

std::string packed(const Sample& s) {
  Packer packer;
  carry(packer, s);
  return packer.bytes();
}

Sample unpacked(std::string_view bytes) {
  Unpacker unpacker(bytes, "a file: sample");
  Sample s;
  carry(unpacker, s);
  unpacker.finish();
  return s;
}

}  // namespace

TEST_CASE("what is packed comes back to the last bit") {
  for (const Sample& given : {sample(), Sample()}) {
    const std::string bytes = packed(given);
    const Sample back = unpacked(bytes);
    CHECK(packed(back) == bytes);
    CHECK(back.flag == given.flag);
    CHECK(back.text == given.text);
    CHECK(std::signbit(back.corner[1]) == std::signbit(given.corner[1]));
    CHECK(back.numbers == given.numbers);
    CHECK(back.points.size() == given.points.size());
  }
}

TEST_CASE("bytes that are cut off anywhere, or follow the end, are an error") {
  const std::string bytes = packed(sample());
  const std::string message = "a file: sample is inconsistent: a list has a wrong length";
  for (size_t length = 0; length < bytes.size(); ++length)
    CHECK_THROWS_WITH(unpacked(std::string_view(bytes).substr(0, length)), message);
  CHECK_THROWS_WITH(unpacked(bytes + '\0'), message);
}

TEST_CASE("a length that is damaged allocates nothing") {
  Packer packer;
  packer.number(std::uint64_t{1} << 60);
  packer.number(1.0);
  const auto refuses = [&](auto&& read) {
    Unpacker unpacker(packer.bytes(), "damaged");
    CHECK_THROWS_AS(read(unpacker), Error);
  };
  std::string text;
  std::vector<double> numbers;
  std::vector<Eigen::Vector3d> points;
  refuses([&](Unpacker& unpacker) { unpacker.text(text); });
  refuses([&](Unpacker& unpacker) { unpacker.list(numbers); });
  refuses([&](Unpacker& unpacker) {
    unpacker.list(points, [&](auto& point) { unpacker.fixed(point); });
  });
  CHECK(numbers.capacity() == 0);
  CHECK(points.capacity() == 0);
}

TEST_CASE("what a reader knows besides is asked for") {
  const Unpacker unpacker("", "damaged");
  unpacker.require(true);
  CHECK_THROWS_AS(unpacker.require(false), Error);
}
