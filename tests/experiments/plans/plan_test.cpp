// The content of a plan's file, its mistakes, and the keys of its runs.

#include "experiments/plans/plan.hpp"
#include "experiments/box/vibrated_box.hpp"
#include "geometry/shape/mesh_file.hpp"
#include "problems/scene/scene_file.hpp"
#include "tests/catch.hpp"
#include "tests/support/mesh_writer.hpp"
#include "tests/support/temporary_folder.hpp"

using namespace ballast;
namespace fs = std::filesystem;

namespace {

std::string error_of(const std::string& text) {
  const TemporaryFolder folder;
  const fs::path file = folder.write("plan.toml", text);
  try {
    read_plan(file);
  } catch (const Error& error) {
    CHECK_THAT(error.what(), Catch::StartsWith(file.string()));
    CHECK(std::string(error.what()).find('\n') == std::string::npos);
    return error.what();
  }
  FAIL("was taken: " << text);
  return "";
}

std::string key_with(const std::vector<std::string>& overrides) {
  return planned_run("run", "vibrated_box_small", overrides).key;
}

}  // namespace

TEST_CASE("a plan lists its runs and multiplies its grids") {
  const TemporaryFolder folder;
  const Plan plan = read_plan(folder.write("two.toml", R"(
scene = "vibrated_box_small"
set = ["solver.max_iterations=300"]

[[run]]
name = "reference"
set = ["drive.frequency=10"]

[[run]]
name = "slope"
scene = "incline"
set = ["solver.max_iterations=20"]

[[grid]]
name = "nu"
set = ["scene.duration=0.2"]
vary."drive.frequency" = [1, 2.5]
vary.solver.name = ["nncg", "pgs"]
[[grid.where]]
when."drive.frequency" = [1.0]
set = ["scene.duration=1"]
)"));
  CHECK(plan.name == "two");
  REQUIRE(plan.runs.size() == 6);
  CHECK(plan.runs[0].overrides ==
        std::vector<std::string>{"solver.max_iterations=300", "drive.frequency=10"});
  CHECK(plan.runs[1].scene == "incline");
  CHECK(plan.runs[2].name == "nu-drive.frequency=1-solver.name=nncg");
  CHECK(plan.runs[2].overrides ==
        std::vector<std::string>{"solver.max_iterations=300", "scene.duration=0.2",
                                 "drive.frequency=1", "solver.name=\"nncg\"", "scene.duration=1"});
  CHECK(plan.runs[5].name == "nu-drive.frequency=2.5-solver.name=pgs");
  CHECK(plan.runs[5].overrides.back() == "solver.name=\"pgs\"");
  CHECK(select(plan, "nu-*name=pgs").size() == 2);
  CHECK(select(plan, "").size() == 6);
  CHECK_THROWS_AS(select(plan, "mu-*"), Error);
}

TEST_CASE("a scene's file is looked for beside the plan") {
  const TemporaryFolder folder;
  fs::copy_file(find_scene("incline"), folder.path() / "mine.toml");
  const Plan plan =
      read_plan(folder.write("plan.toml", "scene = \"mine.toml\"\n[[run]]\nname = \"a\"\n"));
  CHECK(fs::equivalent(find_scene(plan.runs[0].scene), folder.path() / "mine.toml"));
}

TEST_CASE("what is wrong with a plan is said with file, key and value") {
  const std::string head = "scene = \"vibrated_box_small\"\n",
                    run = head + "[[run]]\nname = \"a\"\n",
                    grid = head + "[[grid]]\nname = \"s\"\n",
                    varied = grid + "vary.\"drive.frequency\" = [1, 2]\n[[grid.where]]\n";
  const std::string longer_than_any_file(5000, 'n');
  const std::vector<std::pair<std::string, std::string>> table = {
      {"[[run", "not valid TOML"},
      {head, "no runs in it"},
      {"[[run]]\nname = \"a\"\n", "run.0.scene is missing"},
      {head + "[[run]]\nscene = \"incline\"\n", "run.0.name is missing"},
      {head + "[[runs]]\nname = \"a\"\n", "did you mean \"run\"?"},
      {head + "[[run]]\nname = \"a b\"\n", "\"a b\""},
      {head + "[[run]]\nname = \"-x\"\n", "run.name = \"-x\""},
      {"name = \"a/b\"\n" + run, "name = \"a/b\""},
      {run + "[[run]]\nname = \"a\"\n", "stands twice"},
      {run + "set = [\"drive.frequency=-1\"]\n", "run a: "},
      {run + "set = [\"drive.frequency=-1\"]\n", "drive.frequency = -1"},
      {run + "set = \"drive.frequency=1\"\n", "list of texts"},
      {"scene = \"nowhere\"\n[[run]]\nname = \"a\"\n", "no scene of this name"},
      {"scene = \"" + longer_than_any_file + "\"\n[[run]]\nname = \"a\"\n",
       "no scene of this name"},
      {grid, "nothing varied"},
      {grid + "vary = 3\n", "grid.0.vary = 3"},
      {grid + "vary.\"drive.frequency\" = []\n", "no values"},
      {grid + "vary.\"drive.frequence\" = [1]\n", "drive.frequence = 1"},
      // \r within quotes is a letter of the key. The message leaves control characters out.
      {"scene = \"incline\"\n[[grid]]\nname = \"nu\"\nvary.\"contact.\\riction\" = [0.1]\n",
       "contact.?iction"},
      {varied, "no condition"},
      {varied + "when.\"grains.seed\" = 1\n", "grains.seed is not varied"},
      {varied + "when.\"drive.frequency\" = 3\n", "never is 3"},
      {varied + "when.\"drive.frequency\" = 1\nsett = []\n", "did you mean \"set\"?"}};
  for (const auto& [text, message] : table) CHECK_THAT(error_of(text), Catch::Contains(message));
}

TEST_CASE("a plan that is too much to look at is refused before its runs are") {
  const std::string head = "scene = \"vibrated_box_small\"\n";
  std::string numbers = "1";
  for (int k = 2; k <= 101; ++k) numbers += ", " + std::to_string(k);
  const auto grid = [](const std::string& name, const std::string& varied) {
    return "[[grid]]\nname = \"" + name + "\"\nvary.\"drive.frequency\" = [" + varied + "]\n";
  };
  const std::string seeds = "vary.\"grains.seed\" = [" + numbers + "]\n";
  CHECK_THAT(error_of(head + grid("a", numbers) + seeds), Catch::Contains("more than 10000 runs"));
  // Each of the two grids alone is small enough.
  const std::string half =
      "vary.\"grains.seed\" = [" + numbers.substr(0, numbers.find(", 61")) + "]\n";
  CHECK_THAT(error_of(head + grid("a", numbers) + half + grid("b", numbers) + half),
             Catch::Contains("more than 10000 runs"));
  const std::string wide = "set = [\"scene.name=" + std::string(8000, 'x') + "\"]\n";
  CHECK_THAT(error_of(head + wide + grid("a", numbers) + half), Catch::Contains("more than 32 MB"));
}

TEST_CASE("a run is known by what it computes") {
  const std::string key = key_with({});
  CHECK(key.size() == 16);
  CHECK(key_with({"drive.frequency=20"}) == key);  // the value that the scene has anyway
  CHECK(key_with({"drive.frequency=20.0"}) == key);
  CHECK(key_with({"drive.frequency=7", "drive.frequency=20"}) == key);
  for (const char* other : {"drive.frequency=21", "solver.name=pgs", "solver.tolerance=1e-4"})
    CHECK(key_with({other}) != key);
  CHECK(planned_run("another", "vibrated_box_small", {}).key == key);
  // The words are the same, the mesh is another.
  const TemporaryFolder folder;
  const fs::path mesh = folder.path() / "grain.stl";
  const std::vector<std::string> meshes{"grains.meshes=[\"" + mesh.string() + "\"]"};
  write_mesh(mesh, make_box(Vec3(1, 1, 2)));
  const std::string of_mesh = key_with(meshes);
  CHECK(key_with(meshes) == of_mesh);
  write_mesh(mesh, make_box(Vec3(1, 1, 2.5)));
  CHECK(key_with(meshes) != of_mesh);
}

TEST_CASE("what a run amounts to: its packing, its steps, and its work") {
  const std::vector<std::string> overrides{"scene.duration=0.06", "grains.count=20"};
  const PlannedRun box = planned_run("a", "vibrated_box_small", overrides);
  CHECK(box.packing == packing_key(read_scene(find_scene(box.scene), overrides)));
  CHECK(box.steps == 300);  // 0.06 s in steps of 2e-4 s
  CHECK(box.work == 20.0 * 300.0);
  // A third of the longest rain and the lid's 0.1 s at 5e-4 s a step, the last 0.05 s at 2e-4 s.
  CHECK(box.packing_work == Approx(20.0 * ((1.0 + 0.1) / 5e-4 + 0.05 / 2e-4)));
  const PlannedRun body = planned_run("a", "incline", {});
  CHECK(body.packing.empty());
  CHECK(body.packing_work == 0.0);
  CHECK(body.work == static_cast<double>(body.steps));
}
