// Solid fractions of cubes on a grid, which can be counted.

#include "experiments/measure/packing_density.hpp"

#include <cmath>

#include "problems/scene/scene_file.hpp"
#include "tests/catch.hpp"

using namespace ballast;

namespace {

/// Cubes of side 0.5 in the middle of the unit cells of a 4 x 2 x 4 grid.
MechanicalSystem cubes(MotionState& state) {
  std::vector<Vec3> corners;
  for (int k = 0; k < 8; ++k)
    corners.emplace_back(k & 1 ? 0.25 : -0.25, k & 2 ? 0.25 : -0.25, k & 4 ? 0.25 : -0.25);
  const auto cube = std::make_shared<const Polyhedron>(
      corners,
      std::vector<std::vector<int>>{
          {0, 2, 3, 1}, {4, 5, 7, 6}, {0, 1, 5, 4}, {2, 6, 7, 3}, {0, 4, 6, 2}, {1, 3, 7, 5}});
  MechanicalSystem system;
  for (int x = 0; x < 4; ++x)
    for (int y = 0; y < 2; ++y)
      for (int z = 0; z < 4; ++z) {
        BodySpec body;
        body.shape = cube;
        body.mass = 1.0;
        body.inertia = Vec3::Ones();
        body.pose.position = Vec3(x + 0.5, y + 0.5, z + 0.5);
        add_body(system, state, body, 0.125);
      }
  return system;
}

}  // namespace

TEST_CASE("each way of counting gives the fraction that its space and its grains have") {
  MotionState state;
  const MechanicalSystem system = cubes(state);
  const ControlVolume walls(Vec3::Zero(), Vec3(4, 2, 4));
  // cuts the cubes at x = 0.5 and 3.5 in half: their centres are on its faces
  const ControlVolume run(Vec3(0.5, 0, 0), Vec3(3.5, 2, 4));
  const SolidFractions found = solid_fractions(system, state, run, walls, 0.25);
  CHECK(found.as_run == Approx((16 + 8) * 0.125 / 24.0));
  CHECK(found.with_walls == Approx(0.125));
  CHECK(found.inner == Approx(32 * 0.125 / (3.5 * 1.5 * 3.5)));
  CHECK(found.by_centres == Approx(32 * 0.125 / 24.0));
  CHECK(found.whole_grains == Approx(16 * 0.125 / 24.0));
  // the cut at 3.6 goes through the uppermost cubes, from 3.25 to 3.75
  CHECK(found.without_top == Approx(6 * (3 + 0.35 / 0.5) * 0.125 / (3 * 2 * 3.6)));
  CHECK(std::isnan(solid_fractions(system, state, run, walls, 1.0).inner));
}

TEST_CASE("layers are counted each by itself") {
  MotionState state;
  const MechanicalSystem system = cubes(state);
  for (size_t b = 0; b < state.pose.size(); ++b)
    if (state.pose[b].position.z() > 3.0) state.pose[b].position.z() -= 0.5;  // half a cell down
  const LayerFractions layers =
      layer_fractions(system, state, ControlVolume(Vec3::Zero(), Vec3(4, 2, 4)));
  CHECK(layers[0] == Approx(0.125));
  CHECK(layers[1] == Approx(0.125));
  CHECK(layers[2] == Approx(0.125 * 1.5));
  CHECK(layers[3] == Approx(0.125 * 0.5));
}
