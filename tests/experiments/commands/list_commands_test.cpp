// The commands that list solvers, scenes and keys.

#include "problems/scene/scene_file.hpp"
#include "solvers/solver_list.hpp"
#include "tests/support/program.hpp"
#include "tests/support/temporary_folder.hpp"

using namespace ballast;

TEST_CASE("solvers are listed with what they are, as a table") {
  const ProgramResult table = ballast_program({"solvers"});
  CHECK(table.status == 0);
  for (const SolverEntry& entry : solver_list())
    CHECK_THAT(table.output, Catch::Contains("\n" + std::string(entry.name) + " "));
}

TEST_CASE("a check that fails leaves whole lines") {
  const ProgramResult result = ballast_program({"check", "incline", "none.toml"});
  check_failure(result, ExitCode::failure, {"none.toml"});
  CHECK_THAT(result.output, Catch::StartsWith("incline: ") && Catch::EndsWith("\n"));
}

TEST_CASE("scenes are listed, printed, resolved") {
  const ProgramResult list = ballast_program({"scenes"});
  for (const auto& [name, title] : list_scenes())
    CHECK_THAT(list.output, Catch::Contains(name) && Catch::Contains(title));
  CHECK_THAT(ballast_program({"scenes", "incline"}).output, Catch::Contains("[[body]]"));
  // The printed text has no name: a scene has the name of the file that it is printed into.
  std::string resolved = resolve_scene(find_scene("incline")).text;
  const std::string name = "name = \"incline\"\n";
  resolved.erase(resolved.find(name, resolved.find("[scene]")), name.size());
  CHECK(ballast_program({"scenes", "incline", "--resolved"}).output == resolved);
  const ProgramResult changed = ballast_program({"scenes", "incline", "--set", "scene.step=1e-5"});
  CHECK(ballast_program({"scenes", "--set", "scene.step=1e-5", "incline"}).output ==
        changed.output);
  CHECK_THAT(changed.output, Catch::Contains("step = 1e-05"));
  check_failure(ballast_program({"scenes", "none"}), ExitCode::failure, {"none", "vibrated_box"});
  const TemporaryFolder folder;
  folder.write("good.toml", "[scene]\ntitle = \"My own\"\n");
  folder.write("bad.toml", "[scene\n");
  const auto mine = [&](const std::vector<std::string>& words) {
    return ballast_in_shell("BALLAST_SCENES='" + folder.path().string() + "' \"$@\"", words);
  };
  check_failure(mine({"scenes"}), ExitCode::failure, {"bad.toml:1:", "not valid TOML"});
  CHECK_THAT(mine({"scenes"}).output, Catch::Contains("good                  My own\n"));
  check_failure(mine({"run", "none"}), ExitCode::failure, {"none: no scene of", "one of good"});
}
