#pragma once
// Which runs reproduce the paper.

#include "experiments/paper/campaign.hpp"

namespace ballast {

/// Throws SceneFileError when the scene is none, or no vibrated box.
Campaign make_campaign(const CampaignSettings& settings);

}  // namespace ballast
