#include "experiments/box/tiles.hpp"

namespace ballast {

Scene tiled_scene(const Scene& tile, int nx, int ny) {
  Scene scene = tile;
  scene.box.length *= nx;
  scene.box.width *= ny;
  scene.grains->count *= nx * ny;
  scene.deposit.tiles_x = nx;
  scene.deposit.tiles_y = ny;
  return scene;
}

void place_copies(const Scene& scene, const MotionState& tile, MotionState& state) {
  const size_t grains = tile.pose.size() - box_wall_count;
  size_t copy = 0;
  for (const Vec3& corner : tile_corners(scene))
    for (size_t b = 0; b < grains; ++b, ++copy) {
      state.pose[copy] = tile.pose[b];
      state.pose[copy].position += corner;
      state.velocity[copy] = tile.velocity[b];
      state.spin[copy] = tile.spin[b];
    }
}

}  // namespace ballast
