#include "experiments/bench/bench_packing.hpp"

#include <algorithm>
#include <numeric>
#include <tuple>

#include "experiments/box/packing.hpp"
#include "platform/error.hpp"
#include "platform/interrupt.hpp"
#include "problems/scene/scene_file.hpp"

namespace ballast {
namespace {

/// Where a body of one copy is found among the tiles; -1: a wall between two copies.
///
///     | 2 | 3 |   2 x 2 copies, each with its grains numbered in one piece. The walls between
///     | 0 | 1 |   copies fall away; the outer ones become those of one large box.
class TileMap {
 public:
  TileMap(int grains, int nx, int ny) : grains_(grains), nx_(nx), ny_(ny) {}

  int body(int body, int ix, int iy) const {
    if (body < grains_) return (iy * nx_ + ix) * grains_ + body;
    const int wall = body - grains_;
    const bool between = (wall == wall_x_min && ix > 0) || (wall == wall_x_max && ix < nx_ - 1) ||
                         (wall == wall_y_min && iy > 0) || (wall == wall_y_max && iy < ny_ - 1);
    return between ? -1 : nx_ * ny_ * grains_ + wall;
  }

 private:
  int grains_, nx_, ny_;
};

/// Contacts and impulses in the order of their keys.
void sort_memory(StepMemory& memory) {
  std::vector<size_t> order(memory.contacts.size());
  std::iota(order.begin(), order.end(), size_t{0});
  const auto key = [&](size_t k) {
    const ContactPoint& c = memory.contacts[k];
    return std::tuple(c.body_a, c.body_b, c.feature);
  };
  std::sort(order.begin(), order.end(), [&](size_t a, size_t b) { return key(a) < key(b); });
  StepMemory sorted;
  for (const size_t k : order) {
    sorted.contacts.push_back(memory.contacts[k]);
    sorted.impulses.push_back(memory.impulses[k]);
  }
  memory = std::move(sorted);
}

}  // namespace

DepositedBox deposited_box(const std::string& name, const std::vector<std::string>& overrides,
                           const std::filesystem::path& cache) {
  DepositedBox box;
  box.scene = read_scene(find_scene(name), overrides);
  if (!box.scene.grains) throw Error(name + ": has no grains: a bench needs a deposited packing");
  box.rain = make_rain(box.scene);
  const InterruptGuard guard;
  double deposit_seconds = 0.0;
  const PackingOrder order{cache, [] { return !InterruptGuard::requested(); }};
  if (!take_packing(box.scene, box.rain, order, box.packing, deposit_seconds))
    throw Error("interrupted; the same command goes on depositing");
  return box;
}

BenchStart driven_start(const DepositedBox& box) {
  BenchStart start;
  start.system = drive_system(box.scene, box.rain, box.packing, start.state);
  start.memory = box.packing.memory;
  return start;
}

BenchStart tiled_start(const DepositedBox& box, int nx, int ny) {
  Scene scene = box.scene;
  scene.box.length *= nx;
  scene.box.width *= ny;
  const size_t grains = box.rain.grains.size();
  const TileMap map(static_cast<int>(grains), nx, ny);
  const auto shift = [&](size_t ix, size_t iy) {
    return Vec3(ix * box.scene.box.length, iy * box.scene.box.width, 0.0);
  };
  Rain rain;
  BenchStart start;
  for (int iy = 0; iy < ny; ++iy)
    for (int ix = 0; ix < nx; ++ix) {
      rain.grains.insert(rain.grains.end(), box.rain.grains.begin(), box.rain.grains.end());
      for (size_t c = 0; c < box.packing.memory.contacts.size(); ++c) {
        ContactPoint contact = box.packing.memory.contacts[c];
        contact.body_a = map.body(contact.body_a, ix, iy);
        contact.body_b = map.body(contact.body_b, ix, iy);
        if (contact.body_a < 0 || contact.body_b < 0) continue;
        contact.position += shift(ix, iy);
        start.memory.contacts.push_back(contact);
        start.memory.impulses.push_back(box.packing.memory.impulses[c]);
      }
    }
  sort_memory(start.memory);
  start.system = box_system(scene, rain, BoxStage::settle, box.packing.deposit.lid, &start.state);
  // the grains of each copy are where they rest in the packing, not where they begin to rain
  for (size_t b = 0; b < rain.grains.size(); ++b) {
    const size_t tile = b / grains, grain = b % grains;
    start.state.pose[b] = box.packing.state.pose[grain];
    start.state.pose[b].position += shift(tile % nx, tile / nx);
    start.state.velocity[b] = box.packing.state.velocity[grain];
    start.state.spin[b] = box.packing.state.spin[grain];
  }
  return start;
}

}  // namespace ballast
