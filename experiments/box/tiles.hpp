#pragma once
// A large box begins as copies of a tile's packing (deposit.tiles_x and tiles_y): it costs the
// deposit of a small box, and the rest of the copies.

#include "experiments/box/vibrated_box.hpp"

namespace ballast {

/// nx by ny tiles of this box in one: grains.count, box.length and box.width grow with them.
Scene tiled_scene(const Scene& tile, int nx, int ny);

/// Puts copies of the tile's grains into a state of the tiled box, whose walls stay as they are.
/// Copies do not overlap, because each lay between its walls. Where those stood, a seam of a
/// grain's width is loose.
void place_copies(const Scene& scene, const MotionState& tile, MotionState& state);

}  // namespace ballast
