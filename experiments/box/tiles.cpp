#include "experiments/box/tiles.hpp"

#include <algorithm>
#include <numeric>
#include <tuple>

namespace ballast {
namespace {

/// By (body_a, body_b, feature), as a detection lists contacts.
void sort_memory(StepMemory& memory) {
  std::vector<size_t> order(memory.contacts.size());
  std::iota(order.begin(), order.end(), size_t{0});
  std::ranges::sort(order, {}, [&](size_t k) {
    const ContactPoint& c = memory.contacts[k];
    return std::tuple(c.body_a, c.body_b, c.feature);
  });
  StepMemory sorted;
  for (const size_t k : order) {
    sorted.contacts.push_back(memory.contacts[k]);
    sorted.impulses.push_back(memory.impulses[k]);
  }
  memory = std::move(sorted);
}

}  // namespace

Scene tiled_scene(const Scene& tile, int nx, int ny) {
  Scene scene = tile;
  scene.box.length *= nx;
  scene.box.width *= ny;
  scene.grains->count *= nx * ny;
  scene.deposit.tiles_x = nx;
  scene.deposit.tiles_y = ny;
  return scene;
}

void place_copies(const Scene& scene, const Checkpoint& tile, MotionState& state,
                  StepMemory& memory) {
  const int nx = scene.deposit.tiles_x, ny = scene.deposit.tiles_y,
            grains = static_cast<int>(tile.state.pose.size()) - box_wall_count,
            all = nx * ny * grains;
  memory = {};
  //     | 2 | 3 |   2 x 2 copies, each with its grains numbered in one piece. The walls between
  //     | 0 | 1 |   copies fall away; the outer ones become those of one large box.
  int copy = 0;
  for (const Vec3& corner : tile_corners(scene)) {
    const int first = copy * grains, ix = copy % nx, iy = copy / nx;
    const auto body_here = [&](int body) {  // -1: a wall between two copies
      const int wall = body - grains;
      if (wall < 0) return first + body;
      const bool is_between = (wall == wall_x_min && ix > 0) ||
                              (wall == wall_x_max && ix < nx - 1) ||
                              (wall == wall_y_min && iy > 0) || (wall == wall_y_max && iy < ny - 1);
      return is_between ? -1 : all + wall;
    };
    for (int b = 0; b < grains; ++b) {
      state.pose[first + b] = tile.state.pose[b];
      state.pose[first + b].position += corner;
      state.velocity[first + b] = tile.state.velocity[b];
      state.spin[first + b] = tile.state.spin[b];
    }
    for (size_t c = 0; c < tile.memory.contacts.size(); ++c) {
      ContactPoint contact = tile.memory.contacts[c];
      contact.body_a = body_here(contact.body_a);
      contact.body_b = body_here(contact.body_b);
      if (contact.body_a < 0 || contact.body_b < 0) continue;
      contact.position += corner;
      memory.contacts.push_back(contact);
      memory.impulses.push_back(tile.memory.impulses[c]);
    }
    ++copy;
  }
  sort_memory(memory);
}

}  // namespace ballast
