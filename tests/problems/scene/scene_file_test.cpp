// Scenes: what is read is what the file says.

#include "problems/scene/scene_file.hpp"

#include "tests/catch.hpp"
#include "tests/problems/scene/scene_texts.hpp"
#include "tests/support/temporary_folder.hpp"

using namespace ballast;

TEST_CASE("every scene of the folder is read, and its resolved text says the same") {
  REQUIRE(list_scenes().size() >= 13);
  const TemporaryFolder folder;
  for (const auto& [name, title] : list_scenes()) {
    INFO(name);
    const auto file = find_scene(name);
    const Scene scene = read_scene(file);
    CHECK(scene.name == name);
    CHECK(scene.title == title);
    CHECK(!title.empty());
    const std::string resolved = resolved_scene_text(file);
    CHECK(resolved_scene_text(folder.write("resolved.toml", resolved)) == resolved);
  }
}

TEST_CASE(
    "the vibrated box names the paper's values, and its chosen ones are the defaults "
    "but the solver's limits and the stored forces") {
  const Scene scene = read_scene(find_scene("vibrated_box"));
  REQUIRE(scene.grains);
  CHECK(scene.grains->count == 1200);
  CHECK(scene.step == 2e-4);
  CHECK(scene.duration == 1.0);
  CHECK(scene.step_count() == 5000);
  CHECK(scene.friction == 0.4);
  CHECK(scene.box.friction_horizontal == 0.4);
  CHECK(scene.box.friction_vertical == 0.0);
  CHECK(scene.drive.frequency == 5.0);
  CHECK(scene.drive.f_min_over_weight == 0.0);
  CHECK(scene.drive.lid_raise == 0.01);
  CHECK(scene.gravity == Vec3(0, 0, -9.81));
  REQUIRE(scene.grains->distribution.size() == 3);
  CHECK(scene.grains->distribution[1].size == 0.0375);
  CHECK(scene.grains->distribution[1].fraction == 0.34);

  // a file that names only what has no default must mean the same: defaults of scene.hpp and the
  // file can't drift apart
  const TemporaryFolder folder;
  const auto bare = folder.write("vibrated_box.toml",
                                 "[grains]\ncount = 1200\n[box]\nlength = 0.54\nwidth = 0.54\n");
  CHECK(scene.solver.tolerance == 1e-2);
  CHECK(scene.solver.max_iterations == 1000);
  const std::vector<std::string> named = {"scene.title=\"" + scene.title + "\"",
                                          "solver.tolerance=1e-2", "solver.max_iterations=1000",
                                          "record.forces=true"};
  CHECK(resolved_scene_text(bare, named) == resolved_scene_text(find_scene("vibrated_box")));
}

TEST_CASE(
    "single bodies are solved by what holds whatever their masses are, unless they say else") {
  const TemporaryFolder folder;
  const std::string one_wall = "[[wall]]\nnormal = [0, 0, 1]\n";
  const SolverSpec spec = read_scene(folder.write("a.toml", one_wall)).solver;
  CHECK(spec.name == "auto");
  CHECK(spec.max_iterations == 1000);
  const SolverSpec named =
      read_scene(folder.write("b.toml", "[solver]\nname = \"pgs\"\n" + one_wall)).solver;
  CHECK(named.name == "pgs");
}

TEST_CASE(
    "what is skipped stands in the resolved text only where it was given: older runs keep their "
    "key") {
  const TemporaryFolder folder;
  const auto bare = folder.write("bare.toml", one_wall),
             skipping = folder.write("skipping.toml",
                                     one_wall + "[solver]\nislands = true\n[sleep]\nsteps = 7\n");
  CHECK_FALSE(read_scene(bare).solver.islands);
  CHECK_FALSE(read_scene(bare).sleep.enabled);
  const std::string text = resolved_scene_text(bare);
  CHECK_THAT(text, !Catch::Contains("islands") && !Catch::Contains("sleep"));

  CHECK(read_scene(skipping).solver.islands);
  const std::string given = resolved_scene_text(skipping);
  for (const char* line :
       {"islands = true", "[sleep]", "enabled = false", "steps = 7", "velocity = 0.1"})
    CHECK_THAT(given, Catch::Contains(line));
  CHECK(resolved_scene_text(folder.write("skipping.toml", given)) == given);

  const Scene awake =
      read_scene(bare, std::vector<std::string>{"sleep.enabled=true", "sleep.velocity=0.3"});
  CHECK((awake.sleep.enabled && awake.sleep.velocity == 0.3 && awake.sleep.steps == 100));
}
