#pragma once
// A vibrated box of a few grains, which is deposited in a fraction of a second.

#include "problems/scene/scene_file.hpp"

namespace ballast {

inline Scene small_box(std::vector<std::string> more = {}) {
  std::vector<std::string> overrides{"grains.count=5", "deposit.lid_time=0.02",
                                     "deposit.settle_time=0.01"};
  overrides.insert(overrides.end(), more.begin(), more.end());
  return read_scene(find_scene("vibrated_box_small"), overrides);
}

}  // namespace ballast
