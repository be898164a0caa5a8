// The stages that decide: valid scenes, three samples each, and the settings that their names say.

#include "experiments/paper/decisive_stages.hpp"

#include <algorithm>
#include <map>
#include <set>

#include "experiments/box/vibrated_box.hpp"
#include "experiments/paper/sections.hpp"
#include "problems/scene/scene_file.hpp"
#include "tests/catch.hpp"

using namespace ballast;

namespace {

Campaign decisive(const CampaignSettings& settings = {}) {
  CampaignBuilder build(settings);
  add_decisive_stages(build);
  return build.campaign;
}

Scene scene_of(const Campaign& campaign, const CampaignPoint& point) {
  const PlannedRun& run = campaign.runs[point.run].planned;
  return read_scene(find_scene(run.scene), run.overrides);
}

}  // namespace

TEST_CASE("every decisive value has three samples, at 200 iterations or by its tolerance") {
  const Campaign campaign = decisive();
  std::map<std::pair<Varied, double>, std::set<int>> seeds;
  for (const CampaignPoint& point : campaign.points) {
    seeds[{point.varied, point.value}].insert(point.seed);
    const Scene scene = scene_of(campaign, point);
    CHECK(scene.solver.max_iterations >= decisive_iterations);
    CHECK(scene.duration * scene.drive.frequency >= 3.0 - 1e-9);
  }
  for (const auto& [value, samples] : seeds) {
    const bool is_replica = value.first == Varied::replica || value.first == Varied::replica_fast;
    const bool is_law = value.first == Varied::exact_law || value.first == Varied::convex_law;
    CHECK(samples.size() == (is_replica ? 1u : is_law ? 10u : 3u));
  }
}

TEST_CASE("the box is longer at the same height and width, and its grains follow the length") {
  const Campaign campaign = decisive();
  const Scene base = read_scene(find_scene("vibrated_box"), {});
  int seen = 0;
  for (const CampaignPoint& point : campaign.points) {
    if (point.varied != Varied::box_length) continue;
    const Scene scene = scene_of(campaign, point);
    const double longer = scene.box.length / base.box.length;
    CHECK(longer == Approx(point.value / base_box_shape).epsilon(1e-5));
    CHECK(scene.grains->count == Approx(longer * base.grains->count).margin(0.5));
    CHECK(scene.box.width == base.box.width);
    ++seen;
  }
  CHECK(seen == 15);
}

TEST_CASE("replicas share a packing and differ in the seed of their noise alone") {
  const Campaign campaign = decisive();
  std::set<std::string> packings;
  std::set<std::uint64_t> noises;
  for (const CampaignPoint& point : campaign.points) {
    if (point.varied != Varied::replica && point.varied != Varied::replica_fast) continue;
    const Scene scene = scene_of(campaign, point);
    CHECK(scene.drive.start_noise == 1e-12);
    packings.insert(packing_key(scene));
    noises.insert(scene.drive.start_noise_seed);
  }
  CHECK(packings.size() == 1);
  CHECK(noises.size() == 8);
}

TEST_CASE("both laws drive the same packings, and LMGC90's rule stops plain sweeps") {
  const Campaign campaign = decisive();
  std::map<int, std::set<std::string>> packings, solvers;
  int ruled = 0;
  for (const CampaignPoint& point : campaign.points) {
    const Scene scene = scene_of(campaign, point);
    if (point.varied == Varied::rule_frequency) {
      CHECK(scene.solver.name == "pgs");
      CHECK(scene.solver.change_tolerance == 1.666e-4);
      CHECK(scene.solver.change_every == 500);
      ++ruled;
    }
    if (point.varied != Varied::exact_law && point.varied != Varied::convex_law) continue;
    CHECK(scene.grains->count == 300);
    packings[point.seed].insert(packing_key(scene));
    solvers[point.seed].insert(scene.solver.name);
  }
  CHECK(ruled == 6);
  CHECK(packings.size() == 10);
  for (const auto& [seed, keys] : packings) {
    CHECK(keys.size() == 1);
    CHECK(solvers[seed] == std::set<std::string>{"nncg", "sap"});
  }
}

TEST_CASE("the paper's reading is driven as its own scene says") {
  const Scene scene = read_scene(find_scene(reading_scene));
  const Campaign campaign = decisive();
  for (const CampaignPoint& point : campaign.points) {
    if (point.varied != Varied::reading_frequency) continue;
    const PlannedRun& run = campaign.runs[point.run].planned;
    const Scene driven = read_scene(find_scene(run.scene), run.overrides);
    CHECK(run.scene == reading_scene);
    CHECK(driven.drive.frequency == point.value);
    CHECK(driven.drive.f_max_over_weight == scene.drive.f_max_over_weight);
    CHECK(driven.drive.wall_mass_over_grains == scene.drive.wall_mass_over_grains);
    CHECK(driven.solver.max_iterations == scene.solver.max_iterations);
    CHECK(driven.box.length == scene.box.length);
  }
}

TEST_CASE("similar boxes keep their shape, wider ones their height and length") {
  const Campaign campaign = decisive();
  const Scene base = read_scene(find_scene("vibrated_box"), {});
  for (const CampaignPoint& point : campaign.points) {
    if (point.varied != Varied::size_similar && point.varied != Varied::size_wide) continue;
    const Scene scene = scene_of(campaign, point);
    const double area = scene.box.length * scene.box.width,
                 base_area = base.box.length * base.box.width,
                 height = scene.grains->count / area / (base.grains->count / base_area);
    if (point.varied == Varied::size_similar) {
      CHECK(height == Approx(scene.box.length / base.box.length).epsilon(0.01));
      CHECK(scene.box.length == Approx(scene.box.width));
    } else {
      CHECK(height == Approx(1.0).epsilon(0.01));
      CHECK(scene.box.length == base.box.length);
    }
  }
}

TEST_CASE("a stage is a target of its own runs, all of them belong to \"all\"") {
  const Campaign campaign = make_campaign({});
  for (const DecisiveStage& stage : decisive_stages()) {
    std::set<size_t> asked;
    for (const CampaignPoint& point : campaign.points)
      if (point.stage == stage.name) asked.insert(point.run);
    const auto runs = runs_for(campaign, stage.name);
    CHECK_FALSE(runs.empty());
    CHECK(std::set<size_t>(runs.begin(), runs.end()) == asked);
  }
  CHECK(runs_for(campaign, "all").size() == campaign.runs.size());
  CHECK_THROWS_AS(runs_for(campaign, "boxes"), std::invalid_argument);
}

TEST_CASE("a scene of a few grains has the stages too, never narrower than a grain") {
  CampaignSettings settings;
  settings.scene = "vibrated_box_small";
  settings.overrides = {"grains.count=20", "box.length=0.14", "box.width=0.14"};
  const Campaign campaign = decisive(settings);
  const Campaign whole = decisive();
  const auto readings = std::count_if(whole.runs.begin(), whole.runs.end(), [](const auto& run) {
    return run.planned.scene == reading_scene;
  });
  CHECK(readings == 18);
  CHECK(campaign.runs.size() + 18 == whole.runs.size());
}
