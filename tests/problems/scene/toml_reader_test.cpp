// A table read key by key, the TOML that is written, and overrides. Wrong scenes as a whole are in
// scene_errors_test.cpp.

#include "problems/scene/toml_reader.hpp"

#include <cmath>
#include <limits>

#include "tests/problems/scene/scene_texts.hpp"

using namespace ballast;

TEST_CASE("what was read, defaults included, is the resolved table") {
  const toml::table table = toml::parse("a = 1\nname = \"x\"\nquiet = 7\n[part]\nv = [1, 2, 3]\n");
  toml::table resolved;
  TomlTable reader("f.toml", table, resolved);
  double a = 0.0, b = 0.5;
  int n = 7, quiet = 7, absent = 3;
  bool on = true;
  std::uint64_t seed = 3;
  std::string word = "two";
  Vec3 v = Vec3::Zero();
  reader.read("a", &a, in(positive, "m"), Presence::required);
  reader.read("b", &b);
  reader.read("n", &n, whole(0, 9));
  reader.read("quiet", &quiet, {}, Presence::only_where_given);  // not given: has its default
  reader.read("absent", &absent, {}, Presence::only_where_given);
  reader.read("on", &on);
  reader.read("word", &word, one_of({"one", "two"}));
  reader.read("seed", &seed);
  CHECK(reader.text("name") == "x");
  CHECK(reader.texts("list").empty());
  TomlTable part = reader.section("part");
  part.read("v", &v);
  CHECK((a == 1.0 && v == Vec3(1, 2, 3)));
  reader.finish();
  part.finish();
  CHECK(toml_text(resolved) ==
        "a = 1.0\nb = 0.5\nlist = []\nn = 7\nname = \"x\"\non = true\nseed = 3\nword = \"two\"\n\n"
        "[part]\nv = [1.0, 2.0, 3.0]\n");
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

TEST_CASE("a long value is cut in messages") {
  const toml::table table{{"key", std::string(200, 'x')}};
  toml::table resolved;
  CHECK_THROWS_WITH(TomlTable("f.toml", table, resolved).fail("key", "wrong"),
                    Catch::Equals("f.toml: key = \"" + std::string(59, 'x') + "...: wrong"));
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
  CHECK(resolve_scene(file, overrides).text != resolve_scene(file).text);

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
    CHECK_THAT(error_of(folder, text, {override}),
               Catch::Contains("scene.toml (--set)") && Catch::Contains(part));
  }
}

TEST_CASE("a file that cannot be read is said to be what it is") {
  const TemporaryFolder folder;
  CHECK_THROWS_WITH(load_toml(folder.path(), {}), Catch::Contains("Is a directory"));
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
