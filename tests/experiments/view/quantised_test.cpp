#include "experiments/view/quantised.hpp"

#include "geometry/shape/pose.hpp"
#include "tests/catch.hpp"
#include "tests/support/unpacked_history.hpp"

namespace ballast {
namespace {

std::vector<std::uint16_t> jumping_numbers(size_t count) {
  Random random(7);
  std::vector<std::uint16_t> values{0, 65535, 0, 32768, 1, 65534};
  while (values.size() < count)
    values.push_back(static_cast<std::uint16_t>(random.uniform(0.0, 65535.99)));
  return values;
}

TEST_CASE("a history of any numbers comes back") {
  const std::vector<std::uint16_t> values = jumping_numbers(60);
  for (const size_t columns : {1u, 3u, 60u})
    for (const int order : {1, 2})
      CHECK(unpacked_history<std::uint16_t>(history_bytes(values, columns, order), columns,
                                            order) == values);
  std::vector<std::uint8_t> small;
  for (const std::uint16_t value : values) small.push_back(static_cast<std::uint8_t>(value));
  CHECK(unpacked_history<std::uint8_t>(history_bytes(small, 4), 4, 1) == small);
  CHECK(history_bytes(std::vector<std::uint16_t>{}, 3, 2).empty());
}

TEST_CASE("what moves evenly is zeros, and small steps of either sign are small bytes") {
  std::vector<std::uint16_t> even;
  for (int f = 0; f < 10; ++f) even.push_back(static_cast<std::uint16_t>(1000 + 37 * f));
  const std::string bytes = history_bytes(even, 1, 2);
  for (size_t k = 2; k < 10; ++k) CHECK(bytes[k] == 0);
  const std::vector<std::uint16_t> steps{0, 1, 0, 2};
  CHECK(history_bytes(steps, 1, 1) == std::string("\0\2\1\4\0\0\0\0", 8));
}

TEST_CASE("a number in 16 bits is right to half a step") {
  for (const double value : {-0.3, 0.0, 0.123456, 0.6}) {
    const double back = -0.3 + 0.9 * in_16_bits(value, -0.3, 0.9) / 65535.0;
    CHECK(std::abs(back - value) <= 0.5 * 0.9 / 65535.0 * (1.0 + 1e-9));
  }
  CHECK(in_16_bits(5.0, 0.0, 1.0) == 65535);
  CHECK(in_16_bits(5.0, 5.0, 0.0) == 0);
}

TEST_CASE("a rotation comes back within 1e-4 rad, whatever was left out before") {
  Random random(11);
  double worst = 0.0;
  for (int k = 0; k < 2000; ++k) {
    const Quat q = random_rotation(random);
    for (int before = -1; before < 4; ++before) {
      const SmallestThree packed = smallest_three(q, before);
      const Quat back = unpacked_rotation(packed.kept.data(), packed.left_out);
      worst = std::max(worst, back.angularDistance(q));
    }
  }
  CHECK(worst < 1e-4);
  CHECK(worst > 1e-6);  // else nothing was quantised
}

TEST_CASE("what is left out of a rotation stays while it may") {
  const Quat q = Quat(0.6, 0.7, 0.3, 0.0).normalized();
  CHECK(smallest_three(q, -1).left_out == 1);
  CHECK(smallest_three(q, 0).left_out == 0);  // 0.62: large enough
  CHECK(smallest_three(q, 2).left_out == 1);  // 0.31: not
}

TEST_CASE("signed roots are finest at rest") {
  CHECK(signed_root(0.0) == 128);
  CHECK((signed_root(1.0) == 255 && signed_root(-1.0) == 1 && signed_root(9.0) == 255));
  for (double value = -1.0; value <= 1.0; value += 0.01) {
    const double root = (signed_root(value) - 128) / 127.0;
    CHECK(std::abs(root * std::abs(root) - value) < 1.01 / 127.0);
  }
}

TEST_CASE("directions come back from the octahedron") {
  Random random(3);
  std::vector<Vec3> directions{Vec3::UnitX(), -Vec3::UnitX(), Vec3::UnitZ(), -Vec3::UnitZ()};
  for (int k = 0; k < 500; ++k) directions.push_back(random_direction(random));
  for (const Vec3& direction : directions) {
    const auto bytes = octahedral(direction);
    double x = bytes[0] / 127.5 - 1.0, y = bytes[1] / 127.5 - 1.0;
    const double z = 1.0 - std::abs(x) - std::abs(y);
    if (z < 0.0) {
      const double folded = std::copysign(1.0 - std::abs(y), x);
      y = std::copysign(1.0 - std::abs(x), y);
      x = folded;
    }
    CHECK((Vec3(x, y, z).normalized() - direction).norm() < 0.02);
  }
}

TEST_CASE("floats and words have their bytes in planes") {
  CHECK(float_bytes(std::vector<double>{1.0, 2.0}) == std::string("\0\0\0\0\x80\0\x3f\x40", 8));
  CHECK(word_bytes(std::vector<std::uint16_t>{0x0102, 0x0304}) == "\2\4\1\3");
}

}  // namespace
}  // namespace ballast
