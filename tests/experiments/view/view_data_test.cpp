#include <algorithm>
#include <cmath>

#include "experiments/run/run.hpp"
#include "experiments/view/view.hpp"
#include "platform/atomic_file.hpp"
#include "platform/error.hpp"
#include "problems/files/captured_problem.hpp"
#include "problems/scene/scene_file.hpp"
#include "solvers/solver_list.hpp"
#include "tests/catch.hpp"
#include "tests/support/captured_run.hpp"
#include "tests/support/mesh_writer.hpp"
#include "tests/support/page_sample.hpp"
#include "tests/support/temporary_folder.hpp"

namespace ballast {
namespace {

namespace fs = std::filesystem;

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
  const auto found = std::ranges::find(view.series, name, &ViewSeries::name);
  return found == view.series.end() ? nullptr : &*found;
}

TEST_CASE("a driven wall is known and has its curves, in mm") {
  const TemporaryFolder folder;
  RunData nothing;
  nothing.folder = folder.path();
  CHECK_FALSE(view_of_run(nothing));  // there are no poses
  const RunData run = finished_run(folder, "empty_driven_wall", {"scene.duration=0.05"});
  const auto view = view_of_run(run);
  REQUIRE(view);
  const int wall = view->system.first_driven_wall();
  REQUIRE(wall >= 0);
  const ViewSeries* x = series_of(*view, "x");
  REQUIRE(x);
  CHECK(series_of(*view, "f"));
  CHECK(view->series_time.size() == x->values.size());
  CHECK(x->values.back() == 1e3 * run.steps.back().wall_x);
  // The frames agree with the curve: the wall stands at its start - normal x.
  const Vec3 way = view->frames.back().pose[wall].position - view->frames[0].pose[wall].position;
  CHECK(std::abs(way.norm() - std::abs(run.steps.back().wall_x)) < 1e-12);
}

TEST_CASE("bodies without a driven wall have the energy's curve, and forces where they are kept") {
  const TemporaryFolder folder, other;
  const std::vector<std::string> shorter{"scene.duration=0.03", "record.forces=true"};
  const auto view = view_of_run(finished_run(folder, "incline", shorter));
  REQUIRE(view);
  CHECK(view->system.first_driven_wall() == -1);
  CHECK((series_of(*view, "energy") && !series_of(*view, "x")));
  REQUIRE(view->contacts);
  CHECK_FALSE(view->contacts(view->frames.size() - 1).empty());
  CHECK_THROWS_AS(view->contacts(view->frames.size()), Error);
  CHECK(view->system.friction > 0.0);
  fs::remove(folder.path() / "run" / "record.h5");  // as while a run goes on
  CHECK(view_of_run(read_run_data(folder.path() / "run"))->has_forces_later);
  CHECK_FALSE(view_of_run(finished_run(other, "incline", {"scene.duration=0.03"}))->contacts);
}

TEST_CASE("bodies of parts come back from the record with them") {
  const TemporaryFolder folder;
  const RunData run = finished_run(folder, "chain", {"scene.duration=0.01"});
  const auto view = view_of_run(run);
  REQUIRE(view);
  MotionState state;
  const MechanicalSystem system = make_system(*run.scene, state);
  REQUIRE(view->system.bodies.size() == system.bodies.size());
  for (size_t b = 0; b < system.bodies.size(); ++b) {
    const auto &ours = view->system.bodies[b].shape.parts, &own = system.bodies[b].shape.parts;
    REQUIRE(ours.size() == 4);
    for (size_t k = 0; k < 4; ++k) {
      CHECK(ours[k].pose.position == own[k].pose.position);
      CHECK(ours[k].pose.rotation.coeffs() == own[k].pose.rotation.coeffs());
      for (int v = 0; v < 8; ++v)
        CHECK(ours[k].polyhedron->vertex(v) == own[k].polyhedron->vertex(v));
    }
  }
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

TEST_CASE("the error of a captured problem falls with the iterations, contact by contact") {
  const TemporaryFolder folder;
  const fs::path file = captured_run(folder.path() / "run");
  const ViewData view =
      view_of_problem(file, {.backends = {"pgs", "auto"}, .most_iterations = 200});
  const CapturedProblem captured = read_captured(file);
  const size_t contacts = captured.problem.friction.size();
  REQUIRE(view.contacts);
  REQUIRE(view.contacts(0).size() == contacts);
  CHECK(view.contacts(0)[0].body_a == captured.id_a[0]);
  REQUIRE(view.errors.size() == 2);
  for (const ViewErrors& errors : view.errors) {
    CHECK(errors.iterations == std::vector<int>{1, 3, 10, 30, 100, 200});
    REQUIRE(errors.error.size() == 6);
    for (size_t budget = 0; budget < 6; ++budget) {
      double square = 0.0;
      for (const double error : errors.error[budget]) square += error * error;
      CHECK(std::abs(std::sqrt(square / static_cast<double>(contacts)) - errors.rms[budget]) <=
            1e-9 * errors.rms[budget] + 1e-15);
    }
  }
  CHECK(view.errors[0].rms[5] < 0.1 * view.errors[0].rms[0]);
  const fs::path page = folder.path() / "page.html";
  write_view_page(view, page);
  check_page(read_whole_file(page));
  CHECK_THROWS_AS(view_of_problem(file, {.backends = {"nobody"}}), UnknownSolver);
}

TEST_CASE("a problem alone knows where its bodies are: there where the run has them") {
  const TemporaryFolder folder;
  const fs::path file = captured_run(folder.path() / "run");
  const ErrorQuestion question{.backends = {"pgs"}, .most_iterations = 10};
  const ViewData in_run = view_of_problem(file, question);
  fs::copy_file(file, folder.path() / "alone.hdf5");
  const ViewData alone = view_of_problem(folder.path() / "alone.hdf5", question);
  CHECK(in_run.has_shapes);
  CHECK_FALSE(alone.has_shapes);
  CHECK(alone.errors[0].error == in_run.errors[0].error);
  REQUIRE(alone.system.grain_count == in_run.system.grain_count);
  const auto contacts = alone.contacts(0), known_contacts = in_run.contacts(0);
  REQUIRE(contacts.size() == known_contacts.size());
  for (size_t c = 0; c < contacts.size(); ++c) {
    const FrameContact &mine = contacts[c], &known = known_contacts[c];
    for (const auto& [body, other] :
         {std::pair(mine.body_a, known.body_a), std::pair(mine.body_b, known.body_b)}) {
      const auto b = static_cast<size_t>(body), o = static_cast<size_t>(other);
      REQUIRE(alone.system.bodies[b].is_wall() == in_run.system.bodies[o].is_wall());
      if (alone.system.bodies[b].is_wall()) continue;
      CHECK(alone.system.bodies[b].mass == Approx(in_run.system.bodies[o].mass));
      // The contact point is a corner of the hull, or inside.
      CHECK(alone.system.bodies[b].shape.polyhedron->circumradius() >
            (mine.position.cast<double>() - alone.frames[0].pose[b].position).norm() - 1e-6);
    }
  }
}

}  // namespace
}  // namespace ballast
