#include "experiments/view/still_scene.hpp"

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

}  // namespace
}  // namespace ballast
