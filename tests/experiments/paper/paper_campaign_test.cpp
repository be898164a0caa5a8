// The campaign: every sweep that is asked for is there, nothing twice, and all of it valid scenes.

#include <map>
#include <set>

#include "experiments/paper/make_campaign.hpp"
#include "problems/scene/scene_file.hpp"
#include "tests/catch.hpp"

using namespace ballast;

namespace {

/// Distinct values of a sweep, each with its number of seeds.
std::map<double, std::set<int>> values_of(const Campaign& campaign, Sweep sweep) {
  std::map<double, std::set<int>> values;
  for (const CampaignPoint& point : campaign.points)
    if (point.sweep == sweep) values[point.value].insert(point.seed);
  return values;
}

}  // namespace

TEST_CASE("the campaign has the sweeps that the paper needs, three samples each") {
  const Campaign campaign = make_campaign({});
  const std::map<Sweep, size_t> least{
      {Sweep::frequency, 10}, {Sweep::force, 5}, {Sweep::gravity, 4}, {Sweep::wall_mass, 4}};
  for (const auto& [sweep, count] : least) {
    const auto values = values_of(campaign, sweep);
    CHECK(values.size() >= count);
    for (const auto& [value, seeds] : values) CHECK(seeds.size() == 3);
  }
  CHECK(values_of(campaign, Sweep::frequency).begin()->first == 1.0);
  CHECK(values_of(campaign, Sweep::frequency).rbegin()->first == 60.0);
  CHECK(campaign.motion.size() == 3);
}

TEST_CASE("runs of the campaign are valid scenes, named once, and shared between sweeps") {
  const Campaign campaign = make_campaign({});
  std::set<std::string> names, texts;
  for (const CampaignRun& run : campaign.runs) {
    names.insert(run.planned.name);
    texts.insert(resolved_scene_text(find_scene(run.planned.scene), run.planned.overrides));
    const Scene scene = read_scene(find_scene(run.planned.scene), run.planned.overrides);
    CHECK(scene.step_count() == run.steps);
    CHECK(run.seconds > 0.0);
    CHECK(scene.duration * scene.drive.frequency >= 3.0 - 1e-9);
  }
  CHECK(names.size() == campaign.runs.size());
  CHECK(texts.size() == campaign.runs.size());
  CHECK(campaign.points.size() > campaign.runs.size());
}

TEST_CASE("f_max stays the same in newtons where gravity is varied") {
  const Campaign campaign = make_campaign({});
  for (const CampaignPoint& point : campaign.points) {
    if (point.sweep != Sweep::gravity) continue;
    const PlannedRun& run = campaign.runs[point.run].planned;
    const Scene scene = read_scene(find_scene(run.scene), run.overrides);
    CHECK(scene.drive.f_max_over_weight * scene.gravity.norm() ==
          Approx(base_force * base_gravity));
    CHECK(scene.gravity.norm() == Approx(point.value));
  }
}

TEST_CASE("each figure asks for its own runs, all for all of them") {
  const Campaign campaign = make_campaign({});
  CHECK(runs_for(campaign, "fig3") == campaign.motion);
  CHECK(runs_for(campaign, "fig8").size() == 6);
  CHECK(runs_for(campaign, "fig9").size() == 30);
  CHECK(runs_for(campaign, "all").size() == campaign.runs.size());
  for (const std::string& target : paper_targets()) {
    size_t runs = 0;
    std::set<std::string> stages;
    for (const Plan& stage : stages_of(campaign, target)) {
      runs += stage.runs.size();
      CHECK(stages.insert(stage.name).second);
    }
    CHECK(runs == runs_for(campaign, target).size());
  }
  CHECK_THROWS_WITH(runs_for(campaign, "fig2"),
                    Catch::Contains("'fig2'") && Catch::Contains("fig13"));
}
