// Bodies and walls are what their tables say.

#include "problems/scene/scene_bodies.hpp"

#include <numbers>

#include "geometry/shape/mesh_file.hpp"
#include "problems/scene/scene_file.hpp"
#include "tests/catch.hpp"
#include "tests/problems/scene/scene_texts.hpp"
#include "tests/support/mesh_writer.hpp"
#include "tests/support/temporary_folder.hpp"

using namespace ballast;

namespace {

Scene read_text(const TemporaryFolder& folder, const std::string& text,
                const std::vector<std::string>& overrides = {}) {
  return read_scene(folder.write("scene.toml", text), overrides);
}

/// Lowest distance of a body's vertices over a wall [m].
double gap(const BodySpec& body, const WallSpec& wall) {
  double lowest = std::numeric_limits<double>::infinity();
  for (const Vec3& vertex : body.shape->vertices())
    lowest = std::min(lowest, wall.normal.dot(body.pose * vertex) - wall.offset);
  return lowest;
}

}  // namespace

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
  // a box of sides a, b, c: m (b^2 + c^2)/12, ...
  CHECK(body.inertia.x() == Approx(60.0 * 13 / 12).epsilon(1e-13));
  CHECK(body.inertia.y() == Approx(60.0 * 10 / 12).epsilon(1e-13));
  CHECK(body.inertia.z() == Approx(60.0 * 5 / 12).epsilon(1e-13));
  CHECK((body.pose * Vec3(1, 0, 0) - Vec3(1, 3, 3)).norm() < 1e-14);
  CHECK(body.pose.rotation.norm() == Approx(1.0).epsilon(1e-15));
  // spin is given in the world frame and kept in the body frame: the body's x axis is the world's y
  CHECK((body.spin - Vec3(2, 0, 7)).norm() < 1e-14);
  CHECK((body.free_x && !body.free_y && body.free_z && body.free_rotation));
  CHECK(body.force.at(0.1).x() == Approx(3 * std::cos(2 * std::numbers::pi * 0.2 + 0.5)));
  CHECK(body.force.at(0.1).z() == 1.0);
}

TEST_CASE("a mesh is placed by its own frame, scaled, and found beside the scene") {
  const TemporaryFolder folder;
  // a box whose own origin is one of its corners
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

  // the resolved text finds the mesh from elsewhere
  const TemporaryFolder elsewhere;
  const std::string resolved = resolved_scene_text(folder.path() / "scene.toml");
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
  CHECK(wall.mass == 5.0);
  CHECK(wall.load.at(0.125) == Approx(1.0));  // (3 + 1)/2 - (3 - 1)/2 sin(pi/2)
}
