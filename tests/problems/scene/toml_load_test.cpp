// Overrides on the command line, merged into a scene's table.

#include "problems/scene/scene_file.hpp"
#include "problems/scene/toml_reader.hpp"
#include "tests/catch.hpp"
#include "tests/problems/scene/scene_texts.hpp"
#include "tests/support/temporary_folder.hpp"

using namespace ballast;

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
  const auto refusal = [&](const std::string& text) -> std::string {
    try {
      load_toml(folder.write("scene.toml", text), {});
    } catch (const SceneFileError& error) {
      return error.what();
    }
    return "";
  };
  const auto many = [](const std::string& part, int count) {
    std::string text;
    for (int k = 0; k < count; ++k) text += part;
    return text;
  };
  const std::string deep = "more than 32 levels";
  const std::string dots = "a" + many(".a", 20000);
  CHECK_THAT(refusal("b = 1\n" + dots + " = 1\n"), Catch::Contains("scene.toml:2: " + deep));
  CHECK_THAT(refusal("[" + dots + "]\n"), Catch::Contains(deep));
  CHECK_THAT(refusal("a = {" + dots + " = 1}\n"), Catch::Contains(deep));
  CHECK_THAT(refusal("a = " + many("[", 20000)), Catch::Contains(deep));
  CHECK_THAT(refusal("a = \"'\"\n" + dots + " = 1\n"), Catch::Contains("scene.toml:2: " + deep));
  // dots that are no levels
  const std::string text = many(".", 100);
  CHECK(refusal("a = \"" + text + "\"\nb = '" + text + "' # " + text + "\nc = \"\"\"\n\\\"" + text +
                "\n\"\"\"\n") == "");
  std::string numbers = "a = [";
  for (int k = 0; k < 100; ++k) numbers += "0.5, ";
  CHECK(refusal(numbers + "]\n" + many("b = 0.5\n", 1)) == "");
  for (const std::string& override : {dots + "=1", "b={" + dots + "=1}"}) {
    CAPTURE(override.substr(0, 10));
    CHECK_THROWS_WITH(
        load_toml(folder.write("scene.toml", "a = 1\n"), std::vector<std::string>{override}),
        Catch::Contains("(--set)") && Catch::Contains(deep));
  }
}
