#include "experiments/view/view_data.hpp"

#include <algorithm>

#include "experiments/run/run.hpp"
#include "platform/error.hpp"
#include "problems/scene/scene_file.hpp"
#include "tests/catch.hpp"
#include "tests/support/mesh_writer.hpp"
#include "tests/support/temporary_folder.hpp"

namespace ballast {
namespace {

RunData finished_run(const TemporaryFolder& folder, const std::string& scene,
                     std::vector<std::string> overrides) {
  RunOptions options;
  options.scene = scene;
  options.overrides = std::move(overrides);
  options.output = folder.path() / "run";
  run(options);
  return read_run_data(options.output);
}

const ViewSeries* series_of(const ViewData& view, const std::string& name) {
  const auto found = std::find_if(view.series.begin(), view.series.end(),
                                  [&](const ViewSeries& one) { return one.name == name; });
  return found == view.series.end() ? nullptr : &*found;
}

TEST_CASE("a folder without poses has nothing to be seen") {
  const TemporaryFolder folder;
  RunData run;
  run.folder = folder.path();
  CHECK_FALSE(view_of_run(run));
}

TEST_CASE("a driven wall is known and has its curves, in mm") {
  const TemporaryFolder folder;
  const RunData run = finished_run(folder, "empty_driven_wall", {"scene.duration=0.05"});
  const auto view = view_of_run(run);
  REQUIRE(view);
  REQUIRE(view->driven_wall >= 0);
  const ViewSeries* x = series_of(*view, "x");
  REQUIRE(x);
  CHECK(series_of(*view, "f"));
  CHECK(view->series_time.size() == x->values.size());
  CHECK(x->values.back() == 1e3 * run.steps.back().wall_x);
  // and the frames agree with the curve: the wall stands at its start - normal x
  const auto wall = static_cast<size_t>(view->driven_wall);
  const Vec3 way = view->frames.back().pose[wall].position - view->frames[0].pose[wall].position;
  CHECK(std::abs(way.norm() - std::abs(run.steps.back().wall_x)) < 1e-12);
}

TEST_CASE("bodies without a driven wall have the energy's curve, and forces where they are kept") {
  const TemporaryFolder folder, other;
  const std::vector<std::string> shorter{"scene.duration=0.03", "record.forces=true"};
  const auto view = view_of_run(finished_run(folder, "incline", shorter));
  REQUIRE(view);
  CHECK(view->driven_wall == -1);
  CHECK((series_of(*view, "energy") && !series_of(*view, "x")));
  REQUIRE(view->contacts);
  CHECK_FALSE(view->contacts(view->frames.size() - 1).empty());
  CHECK_THROWS_AS(view->contacts(view->frames.size()), Error);
  CHECK(view->friction > 0.0);
  CHECK_FALSE(view_of_run(finished_run(other, "incline", {"scene.duration=0.03"}))->contacts);
}

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
