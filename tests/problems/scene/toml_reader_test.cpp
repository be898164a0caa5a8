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

}  // namespace

TEST_CASE("what was read, defaults included, is the resolved table") {
  Given given("a = 1\nname = \"x\"\n[part]\nv = [1, 2, 3]\n");
  CHECK(given.reader.number("a", positive, "m") == 1.0);
  CHECK(given.reader.number("b", positive, "m", 0.5) == 0.5);
  CHECK(given.reader.whole("n", 0, 9, 7) == 7);
  CHECK(given.reader.flag("on", true));
  CHECK(given.reader.text("name") == "x");
  CHECK(given.reader.choice("word", {"one", "two"}, "two") == "two");
  TomlTable part = given.reader.section("part");
  CHECK(part.vector("v", "m") == Vec3(1, 2, 3));
  given.reader.finish();
  part.finish();
  CHECK(toml_text(given.resolved) ==
        "a = 1.0\nb = 0.5\nn = 7\nname = \"x\"\non = true\nword = \"two\"\n\n[part]\n"
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
  given.reader.number("friction", positive, "", 0.4);
  given.reader.know("fraction");
  CHECK_THROWS_WITH(given.reader.finish(), Contains("f.toml:1: frictoin = 1: unknown key, did you "
                                                    "mean \"friction\"?"));
  Given far("colour = 1\n");
  far.reader.number("b", positive, "", 1.0);
  far.reader.know("a");
  CHECK_THROWS_WITH(far.reader.finish(), Contains("unknown key, expected one of a, b"));
}

TEST_CASE("what is missing or of another type is named with what was expected") {
  Given given("n = 2.5\nlist = [1]\n[[part]]\nx = 1\n[[part]]\nx = -1\n");
  CHECK_THROWS_WITH(given.reader.number("m", positive, "kg"),
                    Contains("m is missing, expected a number > 0 [kg]"));
  CHECK_THROWS_WITH(given.reader.whole("n", 1, 4),
                    Contains("f.toml:1: n = 2.5: not a whole number, "
                             "expected a whole number from 1 to 4"));
  CHECK_THROWS_WITH(given.reader.texts("list"), Contains("expected a list of texts"));
  CHECK_THROWS_WITH(given.reader.choice("w", {"one", "two"}),
                    Contains("expected one of \"one\", \"two\""));
  std::vector<TomlTable> parts = given.reader.sections("part");
  REQUIRE(parts.size() == 2);
  CHECK(parts[0].number("x", positive, "m") == 1.0);
  CHECK_THROWS_WITH(parts[1].number("x", positive, "m"),
                    Contains("f.toml:6: part.1.x = -1: out of range, expected a number > 0 [m]"));
}
