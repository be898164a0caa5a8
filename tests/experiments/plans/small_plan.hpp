#pragma once
// Plans that take a second: the small box, driven briefly.

#include <string>
#include <vector>

#include "experiments/plans/plan_runner.hpp"
#include "experiments/run/run_folder.hpp"
#include "tests/support/same_bits.hpp"
#include "tests/support/temporary_folder.hpp"

namespace ballast {

/// Two packings with two frequencies each. It writes checkpoints often, so that a kill loses
/// little.
inline const char* small_plan = R"(
name = "small"
scene = "vibrated_box_small"
set = ["grains.count=20", "box.length=0.14", "box.width=0.14",
  "scene.duration=0.06", "record.checkpoint_seconds=0.02"]

[[grid]]
name = "nu"
vary."drive.frequency" = [20, 50]
vary."grains.seed" = [1, 2]
)";

inline bool is_finished(const std::filesystem::path& results, const PlannedRun& run) {
  return RunFolder(run_folder(results, run)).is_finished(run.key);
}

/// The bits of every run of the plan.
inline std::vector<std::string> bits_of(const Plan& plan, const std::filesystem::path& results) {
  std::vector<std::string> bits;
  for (const PlannedRun& run : plan.runs) {
    const std::filesystem::path folder = run_folder(results, run);
    bits.push_back(physics_of(folder) + state_of(folder));
  }
  return bits;
}

}  // namespace ballast
