#pragma once
// The stages that decide what the first campaign left open: C against the shape of the box, the
// floor of chaos, the solver's error, deposits, loads, shapes, sizes. Three samples each, paired by
// packing: the same seed is the same grains.

#include <span>

#include "experiments/paper/campaign_builder.hpp"

namespace ballast {

inline constexpr int decisive_iterations = 200;
inline constexpr const char* reading_scene = "vibrated_box_paper";

/// The lengths of the box over the height of the packing in it.
inline constexpr double box_shapes[] = {0.6, 0.87, 1.2, 1.8, 2.5};
/// The same of the campaign's box: 0.54 m over 0.4714 m, the mean of the first three samples, which
/// differ by 1 %. What was measured is in each run's row.
inline constexpr double base_box_shape = 1.1455;

/// The kinds of grains: the values of Varied::shape.
struct GrainKind {
  const char* name;              ///< as the label says it
  const char* word;              ///< as a run's name does
  std::vector<std::string> set;  ///< overrides
};
const std::vector<GrainKind>& grain_kinds();

/// A stage is also a target of `ballast paper`: its runs, and the report of all that is there.
struct DecisiveStage {
  const char* name;
  void (*add)(CampaignBuilder& build);  ///< its runs and points
};
/// The most decisive first.
std::span<const DecisiveStage> decisive_stages();

void add_decisive_stages(CampaignBuilder& build);

}  // namespace ballast
