#include "experiments/view/still_scene.hpp"

#include "experiments/run/run.hpp"
#include "platform/error.hpp"
#include "problems/scene/scene_file.hpp"
#include "tests/catch.hpp"
#include "tests/support/mesh_writer.hpp"
#include "tests/support/temporary_folder.hpp"

namespace ballast {
namespace {

TEST_CASE("a scene, a rain and a mesh can be seen") {
  const TemporaryFolder folder;
  const ViewData incline = view_of_scene(read_scene(find_scene("incline")), folder.path());
  CHECK((incline.frames.size() == 1 && incline.system.grain_count >= 1));
  const ViewData rain = view_of_scene(read_scene(find_scene("vibrated_box_small")), folder.path());
  CHECK(rain.system.grain_count == 60);
  CHECK_THAT(rain.title, Catch::Contains("rain"));
  const auto mesh = folder.path() / "cube.obj";
  write_mesh(mesh, make_box(Vec3(0.1, 0.2, 0.3)));
  const ViewData cube = view_of_mesh(mesh);
  REQUIRE(cube.system.grain_count == 1);
  CHECK(std::abs(cube.system.bodies[0].volume - 0.006) < 1e-12);
}

TEST_CASE("a packing is seen by the scene of a run beside it, with the forces that hold it") {
  const TemporaryFolder folder;
  RunOptions options;
  options.scene = "vibrated_box_small";
  options.overrides = {"grains.count=5", "scene.duration=0.0004"};
  options.output = folder.path() / "results" / "run";
  options.packing_cache = folder.path() / "results" / "packings";
  run(options);
  std::filesystem::path packing;
  for (const auto& entry : std::filesystem::directory_iterator(options.packing_cache))
    if (is_packing_file(entry.path())) packing = entry.path();
  REQUIRE_FALSE(packing.empty());
  const ViewData view = view_of_packing(packing, scenes_around(packing));
  CHECK(view.system.grain_count == 5);
  REQUIRE(view.contacts);
  // the floor carries the grains, and what the lid presses besides
  double weight = 0.0, on_floor = 0.0;
  for (int g = 0; g < 5; ++g) weight += 9.81 * view.system.bodies[static_cast<size_t>(g)].mass;
  for (const FrameContact& contact : view.contacts(0)) {
    if (contact.body_b == 5) on_floor -= static_cast<double>(contact.force.z());
    if (contact.body_a == 5) on_floor += static_cast<double>(contact.force.z());
  }
  CHECK(std::abs(on_floor - weight) < 0.3 * weight);
  // where no scene makes it, it is refused
  CHECK_THROWS_AS(view_of_packing(packing, {read_scene(find_scene("vibrated_box_small"))}), Error);
  CHECK_FALSE(is_packing_file(folder.path() / "checkpoint.bin"));
}

}  // namespace
}  // namespace ballast
