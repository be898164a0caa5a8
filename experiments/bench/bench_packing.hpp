#pragma once
// Packings for `ballast bench`: the vibrated box as deposited, and large ones of the same kind made
// of it.

#include <filesystem>
#include <string>
#include <vector>

#include "experiments/box/packing.hpp"

namespace ballast {

/// A scene with `grains`, and its deposited packing.
struct DepositedBox {
  Scene scene;
  Rain rain;
  Packing packing;
};

/// From `cache`, or deposited now and kept there (resumable). Throws Error: a scene without grains,
/// interrupted; SceneFileError.
DepositedBox deposited_box(const std::string& scene, const std::vector<std::string>& overrides,
                           const std::filesystem::path& cache);

/// A system with its state and warm start.
struct BenchStart {
  MechanicalSystem system;
  MotionState state;
  StepMemory memory;
};

/// The driven box at its first step.
BenchStart driven_start(const DepositedBox& box);

/// nx by ny copies of the packing side by side, without the walls between them, in one large box
/// whose walls stand still (the settling stage: with the raised lid). Blocks do not overlap,
/// because each lay between its walls; where those stood a seam of a grain's width is looser than
/// the rest. Copies share the shapes of the first.
BenchStart tiled_start(const DepositedBox& box, int nx, int ny);

}  // namespace ballast
