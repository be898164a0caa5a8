#pragma once
// The packing of a large box from that of one of its tiles (deposit.tiles_x and tiles_y): it costs
// the deposit of a small box, and the rest of the copies under the raised lid.

#include "experiments/box/vibrated_box.hpp"
#include "experiments/record/checkpoint.hpp"

namespace ballast {

/// nx by ny tiles of this box in one: grains.count, box.length and box.width grow with them.
Scene tiled_scene(const Scene& tile, int nx, int ny);

/// Copies of the tile's packing without the walls between them, in the walls of the settling stage.
/// Copies do not overlap, because each lay between its walls. Where those stood, a seam of a
/// grain's width is looser than the rest. Key and phase are left to the caller.
Checkpoint tiled_packing(const Scene& scene, const Rain& rain, const Checkpoint& tile);

}  // namespace ballast
