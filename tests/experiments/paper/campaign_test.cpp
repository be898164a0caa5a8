// The campaign has every variation, its samples are paired by seed, and its stages are as their
// names say.

#include "experiments/paper/paper_data.hpp"

#include <functional>
#include <map>
#include <set>

#include "experiments/box/vibrated_box.hpp"
#include "problems/scene/scene_file.hpp"
#include "tests/catch.hpp"
#include "tests/support/temporary_folder.hpp"

using namespace ballast;

namespace {

const std::vector<PlannedRun>& campaign() {
  static const std::vector<PlannedRun> runs = read_campaign({});
  return runs;
}

/// Calls `see` for every run of the stage. Returns the number of its runs.
int for_stage(const std::string& stage,
              const std::function<void(const PlannedRun&, const Scene&)>& see) {
  int count = 0;
  for (const PlannedRun& run : campaign())
    if (stage_of(run) == stage) {
      see(run, read_scene(find_scene(run.scene), run.overrides));
      ++count;
    }
  return count;
}

}  // namespace

TEST_CASE("every stage has whole periods and three samples, or one packing, or ten") {
  std::map<std::string, std::map<std::string, std::set<std::uint64_t>>> seeds;
  std::set<std::string> keys, stages;
  for (const PlannedRun& run : campaign()) stages.insert(stage_of(run));
  for (const std::string& stage : stages)
    for_stage(stage, [&](const PlannedRun& run, const Scene& scene) {
      INFO(run.name);
      CHECK(scene.step_count() == run.steps);
      CHECK(scene.duration * scene.drive.frequency >= 3.0 - 1e-9);
      // Frames are at the ends of the periods whose motion in space is measured.
      CHECK(scene.record.pose_rate == 20.0);
      keys.insert(run.key);
      std::string setting = run.name;
      if (const size_t at = setting.find("seed="); at != std::string::npos)
        setting.erase(at, setting.find_first_not_of("0123456789", at + 5) - at);
      seeds[stage][setting].insert(scene.grains->seed);
    });
  for (const auto& [stage, settings] : seeds)
    for (const auto& [setting, samples] : settings) {
      INFO(setting);
      if (stage == "replicas" || stage == "sensitivity")
        CHECK(samples.size() == 1);
      else
        CHECK(samples.size() >= 3);
    }
  // The base run is one run, although several stages use it.
  CHECK(keys.size() < campaign().size());
  for (const char* stage :
       {"motion", "frequency", "force", "gravity", "mass", "box", "reading", "replicas", "tightest",
        "deposits", "loads", "shapes", "sizes", "laws", "rule", "slowest"})
    CHECK(stages.contains(stage));
}

TEST_CASE("f_max stays the same in newtons where gravity is varied") {
  CHECK(for_stage("gravity", [](const PlannedRun&, const Scene& scene) {
          CHECK(scene.drive.f_max_over_weight * scene.gravity.norm() == Approx(3.0 * 9.81));
        }) == 12);
}

TEST_CASE("boxes have grains in proportion to their ground, at one height") {
  const Scene base = read_scene(find_scene("vibrated_box"));
  const auto per_ground = [](const Scene& scene) {
    return scene.grains->count / (scene.box.length * scene.box.width);
  };
  CHECK(for_stage("box", [&](const PlannedRun&, const Scene& scene) {
          CHECK(per_ground(scene) == Approx(per_ground(base)).epsilon(1e-3));
          CHECK(scene.box.width == base.box.width);
        }) == 30);
  CHECK(for_stage("sizes", [&](const PlannedRun& run, const Scene& scene) {
          INFO(run.name);
          const bool is_wide = run.name.find("wide") != std::string::npos;
          // Similar boxes also grow in height: as the cube root of the number of grains.
          const double height =
              is_wide ? 1.0 : std::cbrt(scene.grains->count / double(base.grains->count));
          CHECK(per_ground(scene) == Approx(height * per_ground(base)).epsilon(1e-4));
          if (is_wide) CHECK(scene.box.length == base.box.length);
          if (!is_wide) CHECK(scene.box.length == scene.box.width);
        }) == 36);
}

TEST_CASE("replicas share a packing and differ in the seed of their noise alone") {
  std::set<std::string> packings;
  std::set<std::uint64_t> noises;
  for_stage("replicas", [&](const PlannedRun&, const Scene& scene) {
    CHECK(scene.drive.start_noise == 1e-12);
    packings.insert(packing_key(scene));
    noises.insert(scene.drive.start_noise_seed);
  });
  CHECK(packings.size() == 1);
  CHECK(noises.size() == 8);
}

TEST_CASE("both laws drive the same packings, and LMGC90's rule stops plain sweeps") {
  std::map<std::uint64_t, std::set<std::string>> packings, solvers;
  for_stage("laws", [&](const PlannedRun&, const Scene& scene) {
    packings[scene.grains->seed].insert(packing_key(scene));
    solvers[scene.grains->seed].insert(scene.solver.name);
  });
  CHECK(packings.size() == 10);
  for (const auto& [seed, keys] : packings) CHECK(keys.size() == 1);
  for (const auto& [seed, names] : solvers) CHECK(names.size() == 2);
  CHECK(for_stage("rule", [](const PlannedRun&, const Scene& scene) {
          CHECK(scene.solver.name == "pgs");
          CHECK(scene.solver.change_tolerance == 1.666e-4);
          CHECK(scene.solver.change_every == 500);
        }) == 6);
}

TEST_CASE("kinds of grains weigh the same, and what a stage varies is in its scenes") {
  const auto mass = [](const Scene& scene) {
    double sum = 0.0, all = 0.0;
    for (const SizeClass& part : scene.grains->distribution) {
      sum += part.fraction * std::pow(part.size, 3);
      all += part.fraction;
    }
    return scene.grains->count * sum / all;
  };
  const Scene base = read_scene(find_scene("vibrated_box"));
  for_stage("shapes", [&](const PlannedRun&, const Scene& scene) {
    CHECK(mass(scene) == Approx(mass(base)).epsilon(1e-3));
  });
  for_stage("loads", [](const PlannedRun& run, const Scene& scene) {
    CHECK(scene.drive.wall_mass_over_grains == 0.1);
    const bool is_half = run.name.find("half") != std::string::npos;
    CHECK(scene.box.length == (is_half ? 0.27 : 0.54));
    CHECK(scene.drive.lid_raise == 0.01);
  });
  for_stage("tightest",
            [](const PlannedRun&, const Scene& scene) { CHECK(scene.solver.tolerance == 1e-3); });
}

TEST_CASE("another box, other values and a part of the runs are asked for by name") {
  const auto runs = read_campaign({.scene = "vibrated_box_small",
                                   .overrides = {"contact.friction=0.3"},
                                   .only = "force*seed=1"});
  REQUIRE(runs.size() == 5);
  for (const PlannedRun& run : runs) {
    CHECK(stage_of(run) == "force");
    const Scene scene = read_scene(find_scene(run.scene), run.overrides);
    CHECK(run.scene == "vibrated_box_small");
    CHECK(scene.friction == 0.3);
    CHECK(scene.grains->seed == 1);
  }
  CHECK_THROWS_WITH(read_campaign({.scene = "incline"}),
                    Catch::Contains("grains") || Catch::Contains("incline"));
  const TemporaryFolder folder;
  const auto plan = folder.write("mine.toml", "[[run]]\nname = \"one-a\"\nscene = \"incline\"\n");
  CHECK_THROWS_WITH(read_campaign({.plan = plan}), Catch::Contains("has no [grains]"));
}
