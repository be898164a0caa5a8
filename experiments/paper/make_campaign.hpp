#pragma once
// Which runs reproduce the paper, and which of them each figure needs.

#include <string>
#include <vector>

#include "experiments/paper/campaign.hpp"

namespace ballast {

/// Throws SceneFileError when the scene is none, or no vibrated box.
Campaign make_campaign(const CampaignSettings& settings);

/// Names that `ballast paper` takes: fig3 ... fig13, packing, looseness, sensitivity,
/// investigation, all.
std::vector<std::string> paper_targets();
/// Indices of the runs a target needs, in the campaign's order. Throws std::invalid_argument naming
/// the target and what there is.
std::vector<size_t> runs_for(const Campaign& campaign, const std::string& target);
/// What a target needs as plans, one for each stage: to be run in this order. Throws as runs_for.
std::vector<Plan> stages_of(const Campaign& campaign, const std::string& target);

}  // namespace ballast
