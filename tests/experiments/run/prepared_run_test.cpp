#include "experiments/run/prepared_run.hpp"

#include <iostream>

#include "experiments/run/run_folder.hpp"
#include "problems/scene/scene_file.hpp"
#include "tests/support/sample_run.hpp"

using namespace ballast;
namespace fs = std::filesystem;

namespace {

const std::vector<std::string> few_grains{"grains.count=4", "deposit.lid_time=0.02",
                                          "deposit.settle_time=0.01"};

PackingOrder order_in(const fs::path& cache, bool goes_on) {
  return {cache, false, [goes_on] { return goes_on; }};
}

/// prepare_run() without what it says.
bool prepare_quietly(const Scene& scene, const PackingOrder& order, Manifest& manifest,
                     PreparedRun& run) {
  std::ostringstream said;
  std::streambuf* const out = std::cout.rdbuf(said.rdbuf());
  std::streambuf* const errors = std::cerr.rdbuf(said.rdbuf());
  const bool there = prepare_run(scene, order, manifest, run);
  std::cout.rdbuf(out);
  std::cerr.rdbuf(errors);
  return there;
}

}  // namespace

TEST_CASE("a run of single bodies starts as its scene says") {
  const Scene scene = read_scene(find_scene("incline"));
  Manifest manifest("incline", {}, "key");
  PreparedRun run;
  REQUIRE(prepare_run(scene, order_in("/nowhere", true), manifest, run));
  CHECK(run.system.grain_count == static_cast<int>(scene.bodies.size()));
  CHECK(run.driven_wall == -1);
  CHECK_FALSE(run.control_volume.has_value());
  CHECK(std::isnan(manifest.summary_number("grains")));
}

TEST_CASE("a box starts from its packing, and the manifest says what it is") {
  const TemporaryFolder folder;
  const Scene scene = read_scene(find_scene("vibrated_box_small"), few_grains);
  Manifest manifest("box", {}, "key");
  PreparedRun run;
  CHECK_FALSE(prepare_quietly(scene, order_in(folder.path(), false), manifest, run));
  REQUIRE(prepare_quietly(scene, order_in(folder.path(), true), manifest, run));
  REQUIRE(run.system.grain_count == 4);
  CHECK(run.driven_wall == 4 + wall_x_max);
  CHECK((run.state.time == 0.0 && run.state.step == 0));
  CHECK_FALSE(run.memory.contacts.empty());
  double mass = 0.0;
  for (int b = 0; b < 4; ++b) mass += run.system.bodies[b].mass;
  CHECK(manifest.summary_number("grains") == 4);
  CHECK(manifest.summary_number("grain_mass_kg") == Approx(mass));
  CHECK(manifest.summary_number("f_max_N") == Approx(3.0 * mass * 9.81));
  CHECK(manifest.summary_number("deposit_seconds") > 0.0);
  CHECK(manifest.summary_number("lid_m") == run.state.pose[4 + wall_lid].position.z());
  CHECK(manifest.summary_number("lid_m") ==
        Approx(manifest.summary_number("packing_top_m") + scene.drive.lid_raise));
  double smallest = 1.0;
  for (const SizeClass& size : scene.grains->distribution) smallest = std::min(smallest, size.size);
  CHECK(manifest.summary_number("d_min_m") == smallest);
}

TEST_CASE("the system of a folder without a run, or without a state, is an error that says so") {
  const TemporaryFolder place;
  MotionState state;
  CHECK_THAT(run_error([&] { system_of_run(place.path(), state); }), Contains("no run here"));
  const auto text = resolve_scene(find_scene("vibrated_box_small"), few_grains).text;
  RunFolder(place.path()).begin(text, Manifest("box", {}, "key"), false);
  CHECK_THAT(run_error([&] { system_of_run(place.path(), state); }),
             Contains("checkpoint.bin: missing: the run has no state yet"));
  RunFolder(place.path())
      .begin(resolve_scene(find_scene("incline")).text, Manifest("incline", {}, "key"), true);
  CHECK(system_of_run(place.path(), state).grain_count == 1);
  CHECK(state.step == 0);
}
