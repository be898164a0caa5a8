// What there is: solvers, scenes, keys, version.

#include "problems/scene/scene_file.hpp"
#include "solvers/solver_list.hpp"
#include "tests/support/program.hpp"

using namespace ballast;

TEST_CASE("solvers are listed with what they are, as a table") {
  const ProgramResult table = ballast_program({"solvers"});
  CHECK(table.status == 0);
  for (const SolverEntry& entry : solver_list())
    CHECK_THAT(table.output, Catch::Contains("\n" + std::string(entry.name) + " "));
}

TEST_CASE("scenes are listed, printed, resolved, and their keys explained") {
  const ProgramResult list = ballast_program({"scenes"});
  for (const auto& [name, title] : list_scenes())
    CHECK_THAT(list.output, Catch::Contains(name) && Catch::Contains(title));
  CHECK_THAT(ballast_program({"scenes", "incline"}).output, Catch::Contains("[[body]]"));
  // all but the name, which is to be the file's that it is printed into
  std::string resolved = resolved_scene_text(find_scene("incline"));
  const std::string name = "name = \"incline\"\n";
  resolved.erase(resolved.find(name, resolved.find("[scene]")), name.size());
  CHECK(ballast_program({"scenes", "incline", "--resolved"}).output == resolved);
  const ProgramResult changed = ballast_program({"scenes", "incline", "--set", "scene.step=1e-5"});
  CHECK_THAT(changed.output, Catch::Contains("step = 1e-05"));
  check_failure(ballast_program({"scenes", "incline", "--keys"}), ExitCode::usage, {"--keys"});
  check_failure(ballast_program({"scenes", "none"}), ExitCode::failure, {"none", "vibrated_box"});
}

TEST_CASE("the version names commit, compiler and libraries") {
  const ProgramResult version = ballast_program({"version"});
  for (const char* part : {"commit", "compiler", "flags", "Eigen", "processor"})
    CHECK_THAT(version.output, Catch::Contains(part));
}

TEST_CASE("docs/manual/scenes.md ends with the tables of keys: ballast scenes --keys writes them") {
  std::ifstream stream(BALLAST_SOURCE_FOLDER "/docs/manual/scenes.md");
  const std::string docs((std::istreambuf_iterator<char>(stream)),
                         std::istreambuf_iterator<char>());
  CHECK_THAT(docs, Catch::EndsWith(ballast_program({"scenes", "--keys"}).output));
}

TEST_CASE("the tables say unit, default, what is expected and meaning") {
  const std::string page = ballast_program({"scenes", "--keys"}).output;
  for (const char* row : {
           "| `scene.step` | s | `2e-4` | a number > 0 | step h; at most the duration |\n",
           "| `gravity.direction` |  | `[0, 0, -1]` | three finite numbers | any length",
           "| `solver.name` |  | `\"nesterov_pgs\"` | a text | as listed",
           "| `solver.max_seconds` | s | `1e30` | a number > 0 | wall clock",
           "| `grains.count` |  | required | a whole number from 1 to 1000000 | ",
           "| `grains.density` | kg/m³ | `2700` | a number > 0 | ",
           "| `grains.size` |  | `\"radius\"` | one of \"radius\", \"diameter\" | ",
           "| `correction.enabled` |  | `true` | true or false | ",
           "| `load.f_max` | N | required | a number >= 0 | ",
           "| `locked` |  | `[]` | a list of texts | ",
       })
    CHECK_THAT(page, Catch::Contains(row));
}

TEST_CASE("docs/manual/scenes.md describes every key that a scene can have") {
  std::ifstream stream(BALLAST_SOURCE_FOLDER "/docs/manual/scenes.md");
  const std::string docs((std::istreambuf_iterator<char>(stream)),
                         std::istreambuf_iterator<char>());
  REQUIRE(docs.size() > 1000);
  int keys = 0;
  for (const char* name :
       {"vibrated_box", "rolling_sphere", "shaken_plate", "empty_driven_wall", "overhang"}) {
    std::istringstream resolved(resolved_scene_text(find_scene(name)));
    std::string section;
    for (std::string line; std::getline(resolved, line);) {
      if (line.starts_with('['))
        section =
            line.substr(line.find_last_of("[.") + 1, line.find(']') - line.find_last_of("[.") - 1);
      if (line.find(" = ") == std::string::npos) continue;
      ++keys;
      const std::string key = line.substr(0, line.find(" = "));
      INFO(name << ": " << section << "." << key);
      // written `section.key`, or `key` alone in the tables of bodies and walls and in pairs of
      // keys
      CHECK((docs.find(section + "." + key + "`") != std::string::npos ||
             docs.find("`" + key + "`") != std::string::npos));
    }
  }
  CHECK(keys > 100);
}
