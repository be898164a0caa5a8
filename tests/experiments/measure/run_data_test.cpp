// Reading a run's folder: what is there is read, what is missing or broken is said.

#include "experiments/measure/run_data.hpp"

#include <cmath>
#include <fstream>

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

}  // namespace

TEST_CASE("a record alone is read, its gaps are said, and facts are found in it") {
  const TemporaryFolder folder;
  auto steps = some_steps();
  steps[3].load = not_known;
  write_rows(folder.path(), steps);
  const RunData data = read_run_data(folder.path());
  CHECK_FALSE(data.scene);
  REQUIRE(data.steps.size() == steps.size());
  CHECK(data.steps[7].wall_force == steps[7].wall_force);
  REQUIRE(data.notices.size() == 3);
  CHECK_THAT(data.notices[0], Contains("load is not finite in 1 of") && Contains("in row 4"));
  CHECK_THAT(data.notices[1], Contains("manifest.json is missing"));
  CHECK_THAT(data.notices[2], Contains("scene.toml is missing"));
  CHECK(data.facts.step == Approx(SyntheticBox{}.h).epsilon(1e-9));
  CHECK(data.facts.f_max > data.facts.f_min);
  CHECK(data.facts.has_wall);
  CHECK(data.facts.has_packing);
  CHECK(data.facts.solid_fraction_initial == steps[0].solid_fraction);
  CHECK(std::isnan(data.facts.velocity_scale));  // gravity is in no row
}

TEST_CASE("facts come from the manifest, what it lacks from the scene") {
  const TemporaryFolder folder;
  write_rows(folder.path(), some_steps());
  folder.write("manifest.json",
               R"({"summary": {"grain_mass_kg": 100, "f_max_N": 7, "step_s": 1}})");
  std::ofstream(folder.path() / "scene.toml") << resolve_scene(find_scene("vibrated_box")).text;
  const RunData data = read_run_data(folder.path());
  REQUIRE(data.scene);
  CHECK(data.facts.step == 1.0);
  CHECK(data.facts.f_max == 7.0);
  CHECK(data.facts.gravity == Approx(9.81));
  CHECK(data.facts.frequency == 5.0);
  CHECK(data.facts.tolerance == 0.01);
  CHECK(data.facts.wall_mass == Approx(50.0));
  CHECK(data.facts.has_wall);
  // a wall that is driven without grains
  std::ofstream(folder.path() / "scene.toml")
      << resolve_scene(find_scene("empty_driven_wall")).text;
  const RunFacts bare = read_run_data(folder.path()).facts;
  CHECK((bare.has_wall && !bare.has_packing));
  CHECK(bare.frequency == 5.0);
}

TEST_CASE("a record whose time does not grow is refused, as is a folder that isn't there") {
  const TemporaryFolder folder;
  write_rows(folder.path(), std::vector<StepRecord>(2));
  CHECK_THROWS_WITH(read_run_data(folder.path()), Contains("not finite and growing in row 2"));
  CHECK_THROWS_WITH(read_run_data(folder.path() / "none"), Contains("no such folder"));
}
