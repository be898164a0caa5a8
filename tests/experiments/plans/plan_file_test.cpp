// What a plan's file says, and what is wrong with it.

#include <algorithm>

#include "experiments/plans/plan.hpp"
#include "experiments/plans/plan_runner.hpp"
#include "problems/scene/scene_file.hpp"
#include "tests/catch.hpp"
#include "tests/support/temporary_folder.hpp"

using namespace ballast;
namespace fs = std::filesystem;

namespace {

std::string error_of(const std::string& text) {
  const TemporaryFolder folder;
  const fs::path file = folder.write("plan.toml", text);
  try {
    read_plan(file);
  } catch (const SceneFileError& error) {
    CHECK_THAT(error.what(), Catch::StartsWith(file.string()));
    CHECK(std::string(error.what()).find('\n') == std::string::npos);
    return error.what();
  }
  FAIL("was taken: " << text);
  return "";
}

}  // namespace

TEST_CASE("control characters of a varied key stay out of the message") {
  // \r within quotes is a key's letter
  const std::string message = error_of(
      "scene = \"incline\"\n[[grid]]\nname = \"nu\"\nvary.\"contact.\\riction\" = [0.1]\n");
  CHECK_THAT(message, Catch::Contains("contact.?iction"));
}

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
  CHECK_THROWS_AS(select(plan, "mu-*"), SceneFileError);

  write_plan(plan, folder.path() / "again.toml");
  const Plan again = read_plan(folder.path() / "again.toml");
  CHECK(again.name == plan.name);
  REQUIRE(again.runs.size() == plan.runs.size());
  for (size_t k = 0; k < plan.runs.size(); ++k) {
    CHECK(again.runs[k].name == plan.runs[k].name);
    CHECK(again.runs[k].overrides == plan.runs[k].overrides);
    CHECK(run_key(again.runs[k]) == run_key(plan.runs[k]));
  }
}

TEST_CASE("a scene's file is looked for beside the plan") {
  const TemporaryFolder folder;
  fs::copy_file(find_scene("incline"), folder.path() / "mine.toml");
  const Plan plan =
      read_plan(folder.write("plan.toml", "scene = \"mine.toml\"\n[[run]]\nname = \"a\"\n"));
  CHECK(fs::equivalent(find_scene(plan.runs[0].scene), folder.path() / "mine.toml"));
}

TEST_CASE("what is wrong with a plan is said with file, key and value") {
  const std::string head = "scene = \"vibrated_box_small\"\n";
  CHECK_THAT(error_of("[[run"), Catch::Contains("not valid TOML"));
  CHECK_THAT(error_of(head), Catch::Contains("no runs in it"));
  CHECK_THAT(error_of("[[run]]\nname = \"a\"\n"), Catch::Contains("run.0.scene is missing"));
  CHECK_THAT(error_of(head + "[[run]]\nscene = \"incline\"\n"),
             Catch::Contains("run.0.name is missing"));
  CHECK_THAT(error_of(head + "[[runs]]\nname = \"a\"\n"), Catch::Contains("did you mean \"run\"?"));
  CHECK_THAT(error_of(head + "[[run]]\nname = \"a b\"\n"), Catch::Contains("\"a b\""));
  CHECK_THAT(error_of(head + "[[run]]\nname = \"a\"\n[[run]]\nname = \"a\"\n"),
             Catch::Contains("stands twice"));
  CHECK_THAT(error_of(head + "[[run]]\nname = \"a\"\nset = [\"drive.frequency=-1\"]\n"),
             Catch::Contains("run a: ") && Catch::Contains("drive.frequency = -1"));
  CHECK_THAT(error_of(head + "[[run]]\nname = \"a\"\nset = \"drive.frequency=1\"\n"),
             Catch::Contains("list of texts"));
  CHECK_THAT(error_of("scene = \"nowhere\"\n[[run]]\nname = \"a\"\n"),
             Catch::Contains("no scene of this name"));
  const std::string longer_than_any_file(5000, 'n');
  CHECK_THAT(error_of("scene = \"" + longer_than_any_file + "\"\n[[run]]\nname = \"a\"\n"),
             Catch::Contains("no scene of this name"));

  const std::string grid = head + "[[grid]]\nname = \"s\"\n";
  CHECK_THAT(error_of(grid), Catch::Contains("nothing varied"));
  CHECK_THAT(error_of(grid + "vary = 3\n"), Catch::Contains("grid.0.vary = 3"));
  CHECK_THAT(error_of(grid + "vary.\"drive.frequency\" = []\n"), Catch::Contains("no values"));
  CHECK_THAT(error_of(grid + "vary.\"drive.frequence\" = [1]\n"),
             Catch::Contains("drive.frequence = 1"));
  const std::string varied = grid + "vary.\"drive.frequency\" = [1, 2]\n[[grid.where]]\n";
  CHECK_THAT(error_of(varied), Catch::Contains("no condition"));
  CHECK_THAT(error_of(varied + "when.\"grains.seed\" = 1\n"),
             Catch::Contains("grains.seed is not varied"));
  CHECK_THAT(error_of(varied + "when.\"drive.frequency\" = 3\n"), Catch::Contains("never is 3"));
  CHECK_THAT(error_of(varied + "when.\"drive.frequency\" = 1\nsett = []\n"),
             Catch::Contains("did you mean \"set\"?"));
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
  // two grids that are small enough each
  const std::string half =
      "vary.\"grains.seed\" = [" + numbers.substr(0, numbers.find(", 61")) + "]\n";
  CHECK_THAT(error_of(head + grid("a", numbers) + half + grid("b", numbers) + half),
             Catch::Contains("more than 10000 runs"));
  const std::string wide = "set = [\"scene.name=" + std::string(8000, 'x') + "\"]\n";
  CHECK_THAT(error_of(head + wide + grid("a", numbers) + half), Catch::Contains("more than 32 MB"));
}
