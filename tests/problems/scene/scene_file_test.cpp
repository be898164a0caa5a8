// Scenes: they are read as the file says, found by their names, and identified by their keys.

#include <numbers>

#include "geometry/shape/mesh_file.hpp"
#include "platform/text.hpp"
#include "tests/problems/scene/scene_texts.hpp"
#include "tests/support/environment_guard.hpp"
#include "tests/support/mesh_writer.hpp"

using namespace ballast;
namespace fs = std::filesystem;

namespace {

Scene read_text(const TemporaryFolder& folder, const std::string& text,
                const std::vector<std::string>& overrides = {}) {
  return read_scene(folder.write("scene.toml", text), overrides);
}

/// The lowest distance of a body's vertices from a wall [m].
double gap(const BodySpec& body, const WallSpec& wall) {
  double lowest = std::numeric_limits<double>::infinity();
  for (const Vec3& vertex : body.shape->vertices())
    lowest = std::min(lowest, wall.normal.dot(body.pose * vertex) - wall.offset);
  return lowest;
}

/// The same polyhedron with its vertices listed from the last to the first.
Polyhedron renumbered(const Polyhedron& mesh) {
  std::vector<Vec3> vertices(mesh.vertices().rbegin(), mesh.vertices().rend());
  std::vector<std::vector<int>> faces;
  for (int f = 0; f < mesh.face_count(); ++f) {
    faces.emplace_back();
    for (const int v : mesh.face(f)) faces.back().push_back(mesh.vertex_count() - 1 - v);
  }
  return Polyhedron(std::move(vertices), faces);
}

}  // namespace

TEST_CASE("every scene of the folder is read, and its resolved text says the same") {
  REQUIRE(list_scenes().size() >= 13);
  const TemporaryFolder folder;
  for (const auto& [name, title] : list_scenes()) {
    INFO(name);
    const auto file = find_scene(name);
    const auto& [scene, resolved, key] = resolve_scene(file);
    CHECK(scene.name == name);
    CHECK(scene.title == title);
    CHECK(!title.empty());
    const bool has_mesh = resolved.find("\nfile = ") != std::string::npos;  // enters the key
    CHECK((key == content_key(resolved)) != has_mesh);
    CHECK(resolve_scene(folder.write("resolved.toml", resolved)).text == resolved);
    CHECK(scene_friction(file) == scene.friction);
  }
}

TEST_CASE(
    "the vibrated box names the paper's values, and its chosen ones are the defaults "
    "but the solver's limits and the stored forces") {
  const Scene scene = read_scene(find_scene("vibrated_box"));
  REQUIRE(scene.grains);
  CHECK(scene.grains->count == 1200);
  CHECK(scene.step == 2e-4);
  CHECK(scene.duration == 1.0);
  CHECK(scene.step_count() == 5000);
  CHECK(scene.friction == 0.4);
  CHECK(scene.box.friction_horizontal == 0.4);
  CHECK(scene.box.friction_vertical == 0.0);
  CHECK(scene.drive.frequency == 5.0);
  CHECK(scene.drive.f_min_over_weight == 0.0);
  CHECK(scene.drive.lid_raise == 0.01);
  CHECK(scene.gravity == Vec3(0, 0, -9.81));
  REQUIRE(scene.grains->distribution.size() == 3);
  CHECK(scene.grains->distribution[1].size == 0.0375);
  CHECK(scene.grains->distribution[1].fraction == 0.34);

  // A file with only the keys that have no default means the same, so that the defaults of
  // scene.hpp and this file agree.
  const TemporaryFolder folder;
  const auto bare = folder.write("vibrated_box.toml",
                                 "[grains]\ncount = 1200\n[box]\nlength = 0.54\nwidth = 0.54\n");
  CHECK(scene.solver.tolerance == 1e-2);
  CHECK(scene.solver.max_iterations == 1000);
  const std::vector<std::string> named = {"scene.title=\"" + scene.title + "\"",
                                          "solver.tolerance=1e-2", "solver.max_iterations=1000",
                                          "record.forces=true"};
  CHECK(resolve_scene(bare, named).text == resolve_scene(find_scene("vibrated_box")).text);
}

TEST_CASE("bodies rest on their walls without gap or overlap at the start") {
  for (const char* name :
       {"incline", "stick_slip", "shaken_plate", "tipping_box", "sliding_cube", "rolling_sphere"}) {
    INFO(name);
    const Scene scene = read_scene(find_scene(name));
    CHECK(gap(scene.bodies.at(0), scene.walls.at(0)) == 0.0);
  }
  const Scene pyramid = read_scene(find_scene("settled_rest"));
  REQUIRE(pyramid.bodies.size() == 10);
  for (int i = 0; i < 4; ++i) CHECK(gap(pyramid.bodies[i], pyramid.walls[0]) == 0.0);
  for (int i = 4; i < 7; ++i) CHECK(gap(pyramid.bodies[i], pyramid.walls[0]) == 0.25);
  const Scene zeno = read_scene(find_scene("zeno_ball"));
  CHECK(gap(zeno.bodies[0], zeno.walls[0]) == Approx(0.2).epsilon(1e-15));
}

TEST_CASE("a body is what its table says") {
  const TemporaryFolder folder;
  const Scene scene = read_text(folder, one_wall + R"(
[[body]]
name = "slab"
shape = "box"
size = [1, 2, 3]
density = 10
position = [1, 2, 3]
orientation = { axis = [0, 0, 5], angle_degrees = 90 }
velocity = [1, 0, 0]
spin = [0, 2, 7]
locked = ["y"]
force = { constant = [0, 0, 1], amplitude = [3, 0, 0], frequency = 2, phase = 0.5 }
)");
  const BodySpec& body = scene.bodies.at(0);
  CHECK(body.name == "slab");
  CHECK(body.mass == Approx(60.0).epsilon(1e-14));
  // A box with the sides a, b, c has m (b^2 + c^2)/12, ...
  CHECK(body.inertia.x() == Approx(60.0 * 13 / 12).epsilon(1e-13));
  CHECK(body.inertia.y() == Approx(60.0 * 10 / 12).epsilon(1e-13));
  CHECK(body.inertia.z() == Approx(60.0 * 5 / 12).epsilon(1e-13));
  CHECK((body.pose * Vec3(1, 0, 0) - Vec3(1, 3, 3)).norm() < 1e-14);
  CHECK(body.pose.rotation.norm() == Approx(1.0).epsilon(1e-15));
  // Spin is given in the world and stored in the body frame: the body's x axis is the world's y.
  CHECK((body.spin - Vec3(2, 0, 7)).norm() < 1e-14);
  CHECK((body.free == std::array{true, false, true} && body.free_rotation));
  CHECK(body.force.at(0.1).x() == Approx(3 * std::cos(2 * std::numbers::pi * 0.2 + 0.5)));
  CHECK(body.force.at(0.1).z() == 1.0);
}

TEST_CASE("a mesh is placed by its own frame, scaled, and found beside the scene") {
  const TemporaryFolder folder;
  // A box with the origin at one of its corners.
  const Polyhedron centred = make_box(Vec3(1, 2, 3));
  std::vector<Vec3> corners(centred.vertices().begin(), centred.vertices().end());
  std::vector<std::vector<int>> faces;
  for (int f = 0; f < centred.face_count(); ++f)
    faces.emplace_back(centred.face(f).begin(), centred.face(f).end());
  for (Vec3& corner : corners) corner += Vec3(0.5, 1, 1.5);
  write_mesh(folder.path() / "corner.obj", Polyhedron(corners, faces));
  const Scene scene = read_text(folder, R"(
[[body]]
shape = "mesh"
file = "corner.obj"
scale = 0.5
mass = 2
position = [10, 0, 0]
)");
  const BodySpec& body = scene.bodies.at(0);
  CHECK((body.pose.position - Vec3(10.25, 0.5, 0.75)).norm() < 1e-13);
  Eigen::AlignedBox3d bounds;
  for (const Vec3& vertex : body.shape->vertices()) bounds.extend(body.pose * vertex);
  CHECK((bounds.min() - Vec3(10, 0, 0)).norm() < 1e-13);
  CHECK((bounds.max() - Vec3(10.5, 1, 1.5)).norm() < 1e-13);

  // The resolved text finds the mesh from another folder.
  const TemporaryFolder elsewhere;
  const std::string resolved = resolve_scene(folder.path() / "scene.toml").text;
  CHECK(read_scene(elsewhere.write("scene.toml", resolved)).bodies.size() == 1);
}

TEST_CASE("a wall is what its table says, whatever the length of its normal") {
  const TemporaryFolder folder;
  const Scene scene = read_text(folder, R"(
[[wall]]
name = "piston"
normal = [0, -4, 0]
offset = -8
friction = 0.3
motion = "driven"
mass = 5
load = { f_min = 1, f_max = 3, frequency = 2 }
)");
  const WallSpec& wall = scene.walls.at(0);
  CHECK(wall.normal == Vec3(0, -1, 0));
  CHECK(wall.offset == -2.0);
  CHECK(wall.friction == 0.3);
  CHECK(wall.motion == WallMotion::driven);
  // Without grains the default solver is one for any mass ratio.
  CHECK((scene.solver.name == "auto" && scene.solver.max_iterations == 100000));
  CHECK(wall.mass == 5.0);
  CHECK(wall.load.at(0.125) == Approx(1.0));  // (3 + 1)/2 - (3 - 1)/2 sin(pi/2)
}

TEST_CASE(
    "scenes are found by path, by name and in BALLAST_SCENES, or refused with what there is") {
  const TemporaryFolder folder;
  const auto file = folder.write("mine.toml", "[scene]\ntitle = \"my own\"\n" + one_wall);
  CHECK(find_scene(file.string()) == file);
  CHECK_THROWS_WITH(find_scene("mine"), Catch::Contains("mine") && Catch::Contains("vibrated_box"));
  const std::pair<std::string, const char*> wrongs[] = {
      {"none.toml", "none.toml"},
      {"", "no such scene file"},
      {"folder/vibrated_box", "no such scene file"},
      {std::string(5000, 'n'), "no scene of this name"}};
  for (const auto& [name, says] : wrongs)
    CHECK_THROWS_WITH(find_scene(name), Catch::Contains(says));
  const EnvironmentGuard mine("BALLAST_SCENES", folder.path().string());
  CHECK(find_scene("mine") == file);
  REQUIRE(list_scenes().size() == 1);
  CHECK(list_scenes()[0] == std::pair<std::string, std::string>("mine", "my own"));
  const EnvironmentGuard none("BALLAST_SCENES", "/nowhere");
  CHECK_THROWS_WITH(list_scenes(), Catch::Contains("/nowhere: no such folder of scenes"));
}

TEST_CASE("a key that came later, given as it is by default, leaves a scene's text as it was") {
  const auto text = [](const std::vector<std::string>& overrides) {
    return resolve_scene(find_scene("incline"), overrides).text;
  };
  CHECK(text({"record.forces=false"}) == text({}));
  for (const char* key : {"forces", "change_tolerance", "change_every"})
    CHECK_THAT(text({}), !Catch::Contains(key));
  CHECK_THAT(text({"record.forces=true"}), Catch::Contains("forces = true"));
}

TEST_CASE("an edited mesh makes another scene, its time stamp and comments do not") {
  const TemporaryFolder folder;
  const fs::path mesh = folder.path() / "stone.obj";
  const auto body = folder.write("body.toml",
                                 "[[body]]\nshape = \"mesh\"\nfile = \"stone.obj\"\nmass = 1\n"
                                 "[[wall]]\nnormal = [0, 0, 1]\n");
  const std::string base = "grains.meshes=[\"" + mesh.string() + "\"]";
  const std::vector<std::string> grains{base, "grains.count=3"};
  const auto keys = [&] {
    return std::pair(resolve_scene(body).key,
                     resolve_scene(find_scene("vibrated_box_small"), grains).key);
  };
  write_mesh(mesh, make_box(Vec3(1, 2, 3)));
  const auto before = keys();
  fs::last_write_time(mesh, fs::last_write_time(mesh) - std::chrono::hours(1));
  CHECK(keys() == before);
  std::ofstream(mesh, std::ios::app) << "# a note\n";
  CHECK(keys() == before);
  // Another order of the vertices gives other bits.
  for (const Polyhedron& other :
       {make_box(Vec3(1, 2, std::nextafter(3.0, 4.0))), renumbered(make_box(Vec3(1, 2, 3)))}) {
    write_mesh(mesh, other);
    CHECK(keys().first != before.first);
    CHECK(keys().second != before.second);
  }
}
