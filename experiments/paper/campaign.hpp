#pragma once
// The runs from which the paper is reproduced: campaign.toml, which is built into the program, or
// another plan of that kind.

#include <filesystem>
#include <string>
#include <vector>

#include "experiments/plans/plan.hpp"

namespace ballast {

struct CampaignSettings {
  std::filesystem::path plan;          ///< empty: campaign.toml
  std::string scene;                   ///< instead of vibrated_box, name or path; empty: that one
  std::vector<std::string> overrides;  ///< of every run, after the plan's own
  std::string only;                    ///< names of the runs, as a shell's pattern; empty: all
};

struct CampaignRun {
  PlannedRun planned;
  std::string stage;  ///< its name to the first of "-."
  std::string key;    ///< of the resolved scene: equal runs of several stages have one
  long steps = 0;     ///< of the drive
};

/// Stage by stage, the most important first. Throws SceneFileError naming plan, run, key and value.
std::vector<CampaignRun> read_campaign(const CampaignSettings& settings);

}  // namespace ballast
