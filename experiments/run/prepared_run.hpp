#pragma once
// A run before its first step: system, state and warm start.

#include <filesystem>
#include <optional>

#include "experiments/box/packing.hpp"
#include "experiments/run/manifest.hpp"
#include "problems/mechanics/mechanical_system.hpp"

namespace ballast {

/// The run as its loop needs it.
struct PreparedRun {
  MechanicalSystem system;
  MotionState state;
  StepMemory memory;
  int driven_wall = -1;
  std::optional<ControlVolume> control_volume;  ///< of the vibrated box
};

/// The start of the scene: as it says, or driven from its packing, which `order` says where to
/// find. What a reader wants to know of the box is noted in the manifest. False: stopped while
/// depositing. Throws Error.
bool prepare_run(const Scene& scene, const PackingOrder& order, Manifest& manifest,
                 PreparedRun& run);

/// The system of a run's folder, rebuilt from its scene.toml and packing, with its latest
/// checkpointed state. Throws Error, also where a mesh is not the one any more that the run began
/// with.
MechanicalSystem system_of_run(const std::filesystem::path& folder, MotionState& state);

/// The same for looking at, not for stepping: bodies, walls and shapes come from record.h5 where
/// there is one, whatever has become of the scene's files. How walls move is not in it.
MechanicalSystem recorded_system(const std::filesystem::path& folder, MotionState& state);

}  // namespace ballast
