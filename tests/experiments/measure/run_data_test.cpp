// Reads the folder of a run.

#include "experiments/measure/run_data.hpp"

#include <cmath>

#include "platform/error.hpp"
#include "problems/scene/scene_file.hpp"
#include "tests/catch.hpp"
#include "tests/support/synthetic_run.hpp"
#include "tests/support/temporary_folder.hpp"

using namespace ballast;
using Catch::Contains;

namespace {

std::vector<StepRecord> some_steps() {
  SyntheticBox box;
  box.duration = 0.01;
  return synthetic_box(box);
}

void write_run(const TemporaryFolder& folder, const std::vector<StepRecord>& steps,
               const char* scene) {
  write_rows(folder.path(), steps);
  folder.write("manifest.json", R"({"summary": {"grain_mass_kg": 100}})");
  folder.write("scene.toml", resolve_scene(find_scene(scene)).text);
}

}  // namespace

TEST_CASE("a run's gaps are said") {
  const TemporaryFolder folder;
  auto steps = some_steps();
  steps[3].load = not_known;
  write_run(folder, steps, "vibrated_box");
  const RunData data = read_run_data(folder.path());
  REQUIRE(data.steps.size() == steps.size());
  CHECK(data.steps[7].wall_force == steps[7].wall_force);
  REQUIRE(data.notices.size() == 1);
  CHECK_THAT(data.notices[0], Contains("load is not finite in 1 of") && Contains("in row 4"));
}

TEST_CASE("facts come from the scene, and of the packing from the manifest") {
  const TemporaryFolder folder;
  write_run(folder, some_steps(), "vibrated_box");
  const RunFacts box = read_run_data(folder.path()).facts;
  CHECK(box.step == 2e-4);
  CHECK(box.gravity == Approx(9.81));
  CHECK(box.velocity_scale == Approx(9.81 * 2e-4));
  CHECK(box.frequency == 5.0);
  CHECK(box.tolerance == 0.01);
  CHECK(box.f_max == Approx(3.0 * 981.0));
  CHECK(box.wall_mass == Approx(50.0));
  CHECK((box.has_wall && box.has_packing));
  CHECK(std::isnan(box.height));
  const std::vector<std::string> large{"grains.seed=5000000001"};
  folder.write("scene.toml", resolve_scene(find_scene("vibrated_box"), large).text);
  CHECK(read_run_data(folder.path()).facts.seed == 5'000'000'001);
  // A wall that is driven without grains.
  write_run(folder, some_steps(), "empty_driven_wall");
  const RunFacts bare = read_run_data(folder.path()).facts;
  CHECK((bare.has_wall && !bare.has_packing));
  CHECK(bare.frequency == 5.0);
  CHECK(bare.f_max > bare.f_min);
  // Of two driven walls, a step records the first.
  folder.write("scene.toml", resolve_scene(find_scene("empty_driven_wall")).text +
                                 "\n[[wall]]\nname = \"other\"\nnormal = [1, 0, 0]\n"
                                 "offset = -10\nmotion = \"driven\"\nmass = 20\n"
                                 "load = { f_min = 0, f_max = 100, frequency = 7 }\n");
  const RunData two = read_run_data(folder.path());
  REQUIRE(two.scene);
  CHECK(two.facts.frequency == 5.0);
}

TEST_CASE("what cannot be read is named") {
  const TemporaryFolder folder;
  write_run(folder, some_steps(), "vibrated_box");
  folder.write("scene.toml", "[scene]\nname = 3\n");
  const RunData data = read_run_data(folder.path());
  CHECK_FALSE(data.scene);
  CHECK_THAT(data.notices.at(0), Contains("scene.toml"));
  folder.write("manifest.json", "[1, 2]");
  CHECK_THROWS_WITH(read_run_data(folder.path()), Contains("manifest.json"));
  std::filesystem::remove(folder.path() / "manifest.json");
  CHECK_THROWS_WITH(read_run_data(folder.path()), Contains("manifest.json"));
}

TEST_CASE("a record whose time does not grow is refused, as is a folder that isn't there") {
  const TemporaryFolder folder;
  write_rows(folder.path(), std::vector<StepRecord>(2));
  CHECK_THROWS_WITH(read_run_data(folder.path()), Contains("not finite and growing in row 2"));
  CHECK_THROWS_WITH(read_run_data(folder.path() / "none"), Contains("no such folder"));
}
