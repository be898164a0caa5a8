// The campaign: everything that is to be varied is there, nothing twice, and all of it valid
// scenes.

#include <map>
#include <set>

#include "experiments/paper/campaign.hpp"
#include "problems/scene/scene_file.hpp"
#include "tests/catch.hpp"

using namespace ballast;

namespace {

/// Distinct values of what is varied, each with its number of seeds.
std::map<double, std::set<int>> values_of(const Campaign& campaign, Varied varied) {
  std::map<double, std::set<int>> values;
  for (const CampaignPoint& point : campaign.points)
    if (point.varied == varied) values[point.value].insert(point.seed);
  return values;
}

}  // namespace

TEST_CASE("the campaign varies what the paper needs, three samples each") {
  const Campaign campaign = make_campaign({});
  const std::map<Varied, size_t> least{
      {Varied::frequency, 10}, {Varied::force, 5}, {Varied::gravity, 4}, {Varied::wall_mass, 4}};
  for (const auto& [varied, count] : least) {
    const auto values = values_of(campaign, varied);
    CHECK(values.size() >= count);
    for (const auto& [value, seeds] : values) CHECK(seeds.size() == 3);
  }
  CHECK(values_of(campaign, Varied::frequency).begin()->first == 1.0);
  CHECK(values_of(campaign, Varied::frequency).rbegin()->first == 60.0);
  CHECK(campaign.motion.size() == 3);
}

TEST_CASE("runs of the campaign are valid scenes, named once, and shared between figures") {
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
    if (point.varied != Varied::gravity) continue;
    const PlannedRun& run = campaign.runs[point.run].planned;
    const Scene scene = read_scene(find_scene(run.scene), run.overrides);
    CHECK(scene.drive.f_max_over_weight * scene.gravity.norm() ==
          Approx(base_force * base_gravity));
    CHECK(scene.gravity.norm() == Approx(point.value));
  }
}
