// A table read key by key, alone; whole scenes that are wrong are in scene_errors_test.cpp.

#include "problems/scene/toml_reader.hpp"

#include "problems/scene/toml_text.hpp"
#include "tests/catch.hpp"

using namespace ballast;
using Catch::Contains;

namespace {

struct Given {
  toml::table table, resolved;
  TomlTable reader;
  Given(const char* text) : table(toml::parse(text)), reader("f.toml", table, resolved) {}
};

/// The value of a key that must be there.
template <class Value>
Value required(TomlTable& table, const char* key, const ValueRule& rule = {}) {
  Value value{};
  table.read(key, rule, true, &value);
  return value;
}

/// Of a key that may be absent.
template <class Value>
Value optional(TomlTable& table, const char* key, const ValueRule& rule, Value value) {
  table.read(key, rule, false, &value);
  return value;
}

const ValueRule length{.range = positive, .unit = "m"};
const ValueRule one_or_two{.words = {"one", "two"}};

}  // namespace

TEST_CASE("what was read, defaults included, is the resolved table") {
  Given given("a = 1\nname = \"x\"\n[part]\nv = [1, 2, 3]\n");
  CHECK(required<double>(given.reader, "a", length) == 1.0);
  CHECK(optional(given.reader, "b", length, 0.5) == 0.5);
  CHECK(optional(given.reader, "n", {.low = 0, .high = 9}, 7) == 7);
  CHECK(optional(given.reader, "on", {}, true));
  CHECK(given.reader.text("name") == "x");
  CHECK(optional(given.reader, "word", one_or_two, std::string("two")) == "two");
  CHECK(optional(given.reader, "seed", {}, std::uint64_t{3}) == 3);
  TomlTable part = given.reader.section("part");
  CHECK(required<Vec3>(part, "v", length) == Vec3(1, 2, 3));
  given.reader.finish();
  part.finish();
  CHECK(toml_text(given.resolved) ==
        "a = 1.0\nb = 0.5\nn = 7\nname = \"x\"\non = true\nseed = 3\nword = \"two\"\n\n[part]\n"
        "v = [1.0, 2.0, 3.0]\n");
}

TEST_CASE("a range's ends count as it says") {
  CHECK_FALSE(positive.contains(0.0));
  CHECK(not_negative.contains(0.0));
  CHECK(part_of_one.contains(1.0));
  CHECK_FALSE(part_of_one.contains(0.0));
  CHECK_FALSE(any_number.contains(std::numeric_limits<double>::infinity()));
  CHECK_FALSE(any_number.contains(std::numeric_limits<double>::quiet_NaN()));
}

TEST_CASE("a key that nobody asked for is refused, with the nearest that was") {
  Given given("frictoin = 1\n");
  optional(given.reader, "friction", length, 0.4);
  given.reader.know("fraction");
  CHECK_THROWS_WITH(given.reader.finish(), Contains("f.toml:1: frictoin = 1: unknown key, did you "
                                                    "mean \"friction\"?"));
  Given far("colour = 1\n");
  optional(far.reader, "b", length, 1.0);
  far.reader.know("a");
  CHECK_THROWS_WITH(far.reader.finish(), Contains("unknown key, expected one of a, b"));
}

TEST_CASE("what is missing or of another type is named with what was expected") {
  Given given("n = 2.5\nlist = [1]\n[[part]]\nx = 1\n[[part]]\nx = -1\n");
  CHECK_THROWS_WITH(required<double>(given.reader, "m", {.range = positive, .unit = "kg"}),
                    Contains("m is missing, expected a number > 0 [kg]"));
  CHECK_THROWS_WITH(required<int>(given.reader, "n", {.low = 1, .high = 4}),
                    Contains("f.toml:1: n = 2.5: not a whole number, "
                             "expected a whole number from 1 to 4"));
  CHECK_THROWS_WITH(given.reader.texts("list"), Contains("expected a list of texts"));
  CHECK_THROWS_WITH(required<std::string>(given.reader, "w", one_or_two),
                    Contains("expected one of \"one\", \"two\""));
  std::vector<TomlTable> parts = given.reader.sections("part");
  REQUIRE(parts.size() == 2);
  CHECK(required<double>(parts[0], "x", length) == 1.0);
  CHECK_THROWS_WITH(required<double>(parts[1], "x", length),
                    Contains("f.toml:6: part.1.x = -1: out of range, expected a number > 0 [m]"));
}

TEST_CASE("a value of every type is told from what it is not, and written as TOML") {
  Given given(
      "number = 1.5\nwhole = 1\nflag = true\ntext = \"a\"\nvector = [1, 2, 3]\n"
      "list = [\"a\"]\nshort = [1, 2]\nendless = [1, 2, inf]\n");
  double number = 0.5;
  int whole = 0;
  std::uint64_t seed = 0;
  bool flag = false;
  std::string text;
  Vec3 vector = Vec3::Zero();
  std::vector<std::string> list;
  const std::vector<std::pair<const char*, ValuePlace>> places{
      {"number", &number}, {"whole", &whole},   {"whole", &seed}, {"flag", &flag},
      {"text", &text},     {"vector", &vector}, {"list", &list}};
  const std::vector<std::string> kept{"1.5", "1", "1", "true", "\"a\"", "[1, 2, 3]", "[\"a\"]"};
  for (size_t k = 0; k < places.size(); ++k) {
    const auto& [own, place] = places[k];
    given.reader.read(own, {}, true, place);
    CHECK(kept_text(place) == kept[k]);
    // a whole number is a number too; nothing else is of two types
    for (const char* other : {"number", "whole", "flag", "text", "vector", "list"}) {
      INFO(own << " from " << other);
      if (std::string_view(own) == other || (*own == 'n' && *other == 'w')) continue;
      CHECK_THROWS_WITH(given.reader.read(other, {}, true, place),
                        Contains("expected " + expected_text(place, {})));
    }
  }
  CHECK_THROWS_WITH(given.reader.read("short", {}, true, &vector), Contains("not a vector"));
  number = 2e-4;
  CHECK(kept_text(&number) == "2e-4");
  CHECK_THROWS_WITH(given.reader.read("endless", {}, true, &vector),
                    Contains("entry 2 is no finite number"));
}
