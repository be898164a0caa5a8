// A table read key by key, alone, how TOML is written, and overrides; whole scenes that are wrong
// are in scene_errors_test.cpp.

#include "problems/scene/toml_reader.hpp"

#include <cmath>
#include <limits>

#include "problems/scene/scene_file.hpp"
#include "tests/catch.hpp"
#include "tests/problems/scene/scene_texts.hpp"
#include "tests/support/temporary_folder.hpp"

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

TEST_CASE("tables come sorted: keys, then tables, then lists of tables") {
  CHECK(toml_text(toml::parse(
            "z = 1\na = [1, 2.5, \"x\"]\n[[list]]\nk = true\n[[list]]\n[b.c]\nd = {e = 1}\n")) ==
        "a = [1, 2.5, \"x\"]\nz = 1\n\n[b]\n\n[b.c]\n\n[b.c.d]\ne = 1\n\n[[list]]\nk = true\n"
        "\n[[list]]\n");
}

TEST_CASE("a float keeps its bits and stays a float") {
  for (const double x : {0.1, 1.0, -0.0, 1e300, 5e-324, 1.0 / 3.0, 2e-4, 123456789.0}) {
    const std::string text = toml_value_text(toml::value<double>(x));
    INFO(text);
    const toml::table table = toml::parse("x = " + text);
    REQUIRE(table["x"].is_floating_point());
    CHECK(*table["x"].value<double>() == x);
    CHECK(std::signbit(*table["x"].value<double>()) == std::signbit(x));
  }
  CHECK(toml_value_text(toml::value<double>(std::nan(""))) == "nan");
  CHECK(toml_value_text(toml::value<double>(-std::numeric_limits<double>::infinity())) == "-inf");
}

TEST_CASE("odd keys and texts are quoted, and read back") {
  const toml::table odd{{"a b", "quote \" backslash \\ bell \a"}, {"", 1}};
  const std::string text = toml_text(odd);
  CHECK(toml::parse(text) == odd);
  CHECK(toml_text(toml::parse(text)) == text);
}

TEST_CASE("a long value is cut") {
  CHECK(toml_value_text(toml::value<std::string>("abcdefgh"), 5) == "\"abcd...");
  CHECK(toml_value_text(toml::array{1, 2}, 6) == "[1, 2]");
}

TEST_CASE("the resolved text keeps every bit and any text") {
  const TemporaryFolder folder;
  const std::string title = "quote \\\" backslash \\\\ tab \\t bell \\u0007 \xc3\xa9";
  const auto file = folder.write(
      "odd.toml", one_wall +
                      "offset = 0.1000000000000000055511151231257827\n[scene]\nstep = 5e-324\n"
                      "duration = 4e-312\ntitle = \"" +
                      title + "\"\n[contact]\nfriction = 3\n");
  const Scene first = read_scene(file);
  const Scene again = read_scene(folder.write("again.toml", resolved_scene_text(file)));
  CHECK(again.step == first.step);
  CHECK(again.title == first.title);
  CHECK(first.title.find('\a') != std::string::npos);
  CHECK(again.walls[0].offset == first.walls[0].offset);
  CHECK(again.friction == 3.0);
}

TEST_CASE("overrides reach every value, and are read as TOML or as a bare word") {
  const auto file = find_scene("incline");
  const std::vector<std::string> overrides = {
      "gravity.direction=[0, 0, -2]", "body.0.velocity=[1, 2, 3]", "solver.name=other",
      "wall.0.friction=0.7",          "correction.enabled=false",  "scene.duration=2"};
  const Scene scene = read_scene(file, overrides);
  CHECK(scene.gravity == Vec3(0, 0, -9.81));
  CHECK(scene.bodies[0].velocity == Vec3(1, 2, 3));
  CHECK(scene.solver.name == "other");
  CHECK(scene.walls[0].friction == 0.7);
  CHECK(!scene.correction.enabled);
  CHECK(scene.duration == 2.0);
  CHECK(resolved_scene_text(file, overrides) != resolved_scene_text(file));

  const Scene grains = read_scene(find_scene("vibrated_box"),
                                  std::vector<std::string>{"grains.distribution.2.size=0.06"});
  CHECK(grains.grains->distribution[2].size == 0.06);
}

TEST_CASE("an override that is wrong is refused and blamed") {
  const TemporaryFolder folder;
  const std::string text = one_wall + "[[body]]\nshape = \"box\"\nsize = [1, 1, 1]\nmass = 1\n";
  const std::vector<std::pair<std::string, std::string>> wrongs = {
      {"scene.step", "expected dotted.key=value"},
      {"=3", "empty part"},
      {"scene..step=3", "empty part"},
      {"scene.step=", "scene.step=: not a TOML value"},
      {"scene.step=[1", "scene.step=[1: not a TOML value"},
      {"scene.step=1\nduration=2", "one line"},
      {"scene.step=-1", "scene.step = -1: out of range"},
      {"scene.step=fast", "scene.step = \"fast\": not a number"},
      {"scene.stp=1", "scene.stp = 1: unknown key, did you mean \"step\"?"},
      {"drve.frequency=1", "drve = {frequency = 1}: unknown key, did you mean \"drive\"?"},
      {"body.1.mass=2", "no element 1"},
      {"body.mass=2", "no element mass"},
      {"body.0=2", "expected a key after the index"},
      {"body.0.mass.x=2", "mass is not a table"},
      {"body.0.mas=2", "body.0.mas = 2: unknown key, did you mean \"mass\"?"},
      {"body=2", "expected a list of tables"},
  };
  for (const auto& [override, part] : wrongs) {
    std::string message;
    try {
      read_scene(folder.write("scene.toml", text), std::vector<std::string>{override});
    } catch (const SceneFileError& error) {
      message = error.what();
    }
    CHECK_THAT(message, Catch::StartsWith((folder.path() / "scene.toml").string() + " (--set)"));
    CHECK_THAT(message, Catch::Contains(part));
    CHECK(message.find('\n') == std::string::npos);
  }
}

TEST_CASE("a file that cannot be read is said to be what it is") {
  const TemporaryFolder folder;
  CHECK_THROWS_WITH(load_toml(folder.path(), {}), Catch::Contains("is a folder"));
  CHECK_THROWS_WITH(load_toml(folder.path() / "none.toml", {}), Catch::Contains("cannot open"));
  CHECK_THROWS_WITH(load_toml(folder.write("bad.toml", "a = 1\nb = [2\n"), {}),
                    Catch::Contains("bad.toml:") && Catch::Contains("not valid TOML"));
}

TEST_CASE("tables in tables without end are refused where they stand, before anything is parsed") {
  const TemporaryFolder folder;
  const auto many = [](const std::string& part, int count) {
    std::string text;
    for (int k = 0; k < count; ++k) text += part;
    return text;
  };
  const std::string deep = "more than 1000 dots in a line", dots = "a" + many(".a", 20000);
  const std::pair<std::string, std::string> wrongs[] = {
      {"b = 1\n" + dots + " = 1\n", "scene.toml:2: " + deep},
      {"[" + dots + "]\n", deep},
      {"a = {" + dots + " = 1}\n", deep},
      {"a = " + many("[", 20000), "not valid TOML"},
      {"a = " + many("{a = ", 20000), "not valid TOML"}};
  for (const auto& [text, says] : wrongs)
    CHECK_THROWS_WITH(load_toml(folder.write("scene.toml", text)), Catch::Contains(says));
  CHECK_NOTHROW(
      load_toml(folder.write("scene.toml", "a = [" + many("0.5, ", 1000) + "]\nb = 0.5\n")));
  CHECK_NOTHROW(load_toml(folder.write("scene.toml", "a" + many(".a", 1000) + " = 1\n")));
  for (const std::string& override : {dots + "=1", "b={" + dots + "=1}"}) {
    CAPTURE(override.substr(0, 10));
    CHECK_THROWS_WITH(
        load_toml(folder.write("scene.toml", "a = 1\n"), std::vector<std::string>{override}),
        Catch::Contains("(--set)") && Catch::Contains(deep));
  }
}
