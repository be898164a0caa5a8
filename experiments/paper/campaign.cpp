#include "experiments/paper/campaign.hpp"

#include "experiments/plans/plan_runner.hpp"
#include "platform/atomic_file.hpp"
#include "problems/scene/scene_file.hpp"

#include <unistd.h>

namespace ballast {

namespace fs = std::filesystem;

std::string campaign_plan();  // campaign.toml

namespace {

constexpr const char* usual_scene = "vibrated_box";

/// A plan is a file, so that its scenes have a place.
Plan built_in_plan() {
  const fs::path file =
      fs::temp_directory_path() / ("ballast-campaign-" + std::to_string(getpid()) + ".toml");
  write_whole_file(file, campaign_plan());
  const Plan plan = read_plan(file);
  fs::remove(file);
  return plan;
}

}  // namespace

std::vector<CampaignRun> read_campaign(const CampaignSettings& settings) {
  Plan plan = settings.plan.empty() ? built_in_plan() : read_plan(settings.plan);
  for (PlannedRun& run : plan.runs) {
    if (!settings.scene.empty() && run.scene == usual_scene) run.scene = settings.scene;
    run.overrides.insert(run.overrides.end(), settings.overrides.begin(), settings.overrides.end());
  }
  if (!settings.only.empty()) plan.runs = select(plan, settings.only);
  std::vector<CampaignRun> runs;
  for (const PlannedRun& run : plan.runs) {
    const ResolvedScene scene = resolve_scene(find_scene(run.scene), run.overrides);
    if (!scene.scene.grains)
      throw SceneFileError(run.scene + ": has no [grains], expected a vibrated box");
    runs.push_back({run, run.name.substr(0, run.name.find_first_of("-.")), scene.key,
                    scene.scene.step_count()});
  }
  return runs;
}

}  // namespace ballast
