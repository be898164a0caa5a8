#include "platform/pack.hpp"

#include <Eigen/Dense>

#include <array>
#include <limits>
#include <vector>

#include "platform/atomic_file.hpp"
#include "platform/text.hpp"
#include "tests/catch.hpp"
#include "tests/support/complaint.hpp"
#include "tests/support/temporary_folder.hpp"

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
  refuses([&](Unpacker& unpacker) { unpacker.require(false); });
  CHECK(numbers.capacity() == 0);
  CHECK(points.capacity() == 0);
}

namespace {

constexpr SealedKind kind{"MAGICMAG", "thing", 3};

std::string refusal(const std::filesystem::path& file, std::string_view bytes) {
  write_whole_file(file, bytes);
  const std::string said = complaint_about(file, [&] { read_sealed_file(file, kind); });
  CHECK(said != "");
  return said;
}

}  // namespace

TEST_CASE("a sealed file's bytes are those of its description") {
  const TemporaryFolder folder;
  const auto file = folder.path() / "file";
  write_sealed_file(file, kind, "body");
  std::string expected("MAGICMAG\x03\0\0\0\x04\x03\x02\x01\x04\0\0\0\0\0\0\0body", 28);
  std::uint64_t sum = fnv1a(expected);
  for (int k = 0; k < 8; ++k, sum >>= 8) expected += static_cast<char>(sum & 0xff);
  CHECK(read_whole_file(file) == expected);
  CHECK(read_sealed_file(file, kind) == "body");
}

TEST_CASE("a file of another format is refused") {
  const TemporaryFolder folder;
  const auto file = folder.path() / "file";
  for (const std::uint32_t format : {2u, 4u}) {
    write_sealed_file(file, {kind.magic, kind.name, format}, "body");
    CHECK_THAT(refusal(file, read_whole_file(file)),
               Catch::Contains("thing has format " + std::to_string(format) +
                               ", this program reads format 3"));
  }
}

TEST_CASE("a sealed file that is cut, longer or changed in one bit is refused") {
  const TemporaryFolder folder;
  const auto file = folder.path() / "file";
  write_sealed_file(file, kind, "some body");
  const std::string whole = read_whole_file(file);
  for (size_t length = 0; length < whole.size(); ++length)
    CHECK_THAT(refusal(file, std::string_view(whole).substr(0, length)),
               Catch::Contains(length == 0 ? "thing is empty" : "thing is truncated"));
  CHECK_THAT(refusal(file, whole + "x"), Catch::Contains("thing is truncated or damaged"));
  for (size_t bit = 0; bit < 8 * whole.size(); ++bit) {
    std::string bytes = whole;
    bytes[bit / 8] ^= static_cast<char>(1 << bit % 8);
    const char* why = bit < 64    ? "is not a thing"
                      : bit < 96  ? "thing has format"
                      : bit < 128 ? "thing was written on a machine of another byte order"
                                  : "thing is truncated or damaged";
    CHECK_THAT(refusal(file, bytes), Catch::Contains(why));
  }
  CHECK_THAT(refusal(file, "a text"), Catch::Contains("is not a thing"));
}
