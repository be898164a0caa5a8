// What there is: solvers, scenes, keys, version.

#include <nlohmann/json.hpp>

#include "experiments/commands/scene_keys_page.hpp"
#include "problems/scene/scene_file.hpp"
#include "solvers/solver_list.hpp"
#include "tests/support/program.hpp"

using namespace ballast;

TEST_CASE("solvers are listed with what they are, as a table and as JSON") {
  const ProgramResult table = ballast_program({"solvers"});
  CHECK(table.status == 0);
  const nlohmann::json list = nlohmann::json::parse(ballast_program({"solvers", "--json"}).output);
  REQUIRE(list.size() == solver_list().size());
  for (size_t k = 0; k < list.size(); ++k) {
    CHECK(list[k]["name"] == solver_list()[k].name);
    CHECK(list[k]["built"] == (solver_list()[k].make != nullptr));
    CHECK_THAT(table.output, Catch::Contains("\n" + std::string(solver_list()[k].name) + " "));
  }
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
  CHECK(ballast_program({"scenes", "--keys"}).output == scene_keys_markdown());
  check_failure(ballast_program({"scenes", "incline", "--keys"}), ExitCode::usage, {"--keys"});
  check_failure(ballast_program({"scenes", "none"}), ExitCode::failure, {"none", "vibrated_box"});
}

TEST_CASE("the version names commit, compiler and libraries") {
  const ProgramResult version = ballast_program({"version"});
  for (const char* part : {"commit", "compiler", "flags", "Eigen", "processor"})
    CHECK_THAT(version.output, Catch::Contains(part));
}
