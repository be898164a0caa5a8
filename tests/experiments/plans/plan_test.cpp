#include "experiments/plans/plan.hpp"

#include "geometry/shape/mesh_file.hpp"
#include "problems/scene/scene_file.hpp"
#include "tests/catch.hpp"
#include "tests/support/mesh_writer.hpp"
#include "tests/support/temporary_folder.hpp"

using namespace ballast;
namespace fs = std::filesystem;

namespace {

PlannedRun run_with(std::vector<std::string> overrides) {
  return {"run", "vibrated_box_small", std::move(overrides)};
}

}  // namespace

TEST_CASE("a run is known by what it computes") {
  const std::string key = run_key(run_with({}));
  CHECK(key.size() == 16);
  CHECK(run_key(run_with({"drive.frequency=20"})) == key);  // what the scene says anyway
  CHECK(run_key(run_with({"drive.frequency=20.0"})) == key);
  CHECK(run_key(run_with({"drive.frequency=7", "drive.frequency=20"})) == key);
  CHECK(run_key(run_with({"drive.frequency=21"})) != key);
  CHECK(run_key(run_with({"solver.name=pgs"})) != key);
  CHECK(run_key(run_with({"solver.tolerance=1e-4"})) != key);
  PlannedRun renamed = run_with({});
  renamed.name = "another";
  CHECK(run_key(renamed) == key);
  CHECK(folder_of("r", renamed) == fs::path("r/runs") / key);
  CHECK_FALSE(is_finished("/nowhere", renamed));
}

TEST_CASE("an edited mesh makes another run of the same words") {
  const TemporaryFolder folder;
  const fs::path mesh = folder.path() / "grain.stl";
  const PlannedRun run = run_with({"grains.meshes=[\"" + mesh.string() + "\"]"});
  write_mesh(mesh, make_box(Vec3(1, 1, 2)));
  const std::string key = run_key(run);
  CHECK(run_key(run) == key);
  write_mesh(mesh, make_box(Vec3(1, 1, 2.5)));
  CHECK(run_key(run) != key);
}

TEST_CASE("a plan is checked: names that are names, each once, runs that are scenes") {
  const auto error_of = [](const Plan& plan) -> std::string {
    try {
      validate(plan, "here");
    } catch (const SceneFileError& error) {
      CHECK_THAT(error.what(), Catch::StartsWith("here: "));
      return error.what();
    }
    return "";
  };
  PlannedRun run = run_with({});
  CHECK(error_of({"plan", {run}}).empty());
  CHECK_THAT(error_of({"a/b", {run}}), Catch::Contains("name = \"a/b\""));
  CHECK_THAT(error_of({"plan", {run, run}}), Catch::Contains("stands twice"));
  run.name = "-x";
  CHECK_THAT(error_of({"plan", {run}}), Catch::Contains("run.name = \"-x\""));
  run = run_with({"drive.frequency=-1"});
  CHECK_THAT(error_of({"plan", {run}}), Catch::Contains("run run: "));
}
