// Parts, copies, crowds, motions, materials and periods of a scene file.

#include <numbers>

#include "geometry/shape/mass_properties.hpp"
#include "tests/problems/scene/scene_texts.hpp"
#include "tests/support/mesh_writer.hpp"

using namespace ballast;
using Catch::Matchers::Contains;

namespace {

Scene scene_of(const std::string& text) {
  const TemporaryFolder folder;
  write_mesh(folder.path() / "stone.obj", make_box(Vec3(1, 2, 3)));
  return read_scene(folder.write("scene.toml", text));
}

const std::string cube = "[[body]]\nshape = \"box\"\nsize = [1, 1, 1]\n";

}  // namespace

TEST_CASE("a body of parts has its place, mass and shape from all of them") {
  const Scene scene = scene_of(
      "[[body]]\ndensity = 2\nposition = [1, 2, 3]\n"
      "[[body.part]]\nshape = \"box\"\nsize = [1, 1, 1]\nposition = [2, 0, 0]\n"
      "[[body.part]]\nshape = \"box\"\nsize = [1, 1, 1]\nposition = [-1, 0, 0]\n"
      "orientation = {axis = [0, 0, 1], angle_degrees = 90}\n");
  const BodySpec& body = scene.bodies.at(0);
  CHECK(body.mass == Approx(4.0));
  CHECK((body.pose.position - Vec3(1.5, 2, 3)).norm() < 1e-12);
  REQUIRE(body.parts.size() == 2);
  const Pose& part = body.parts[1].pose;
  CHECK((body.pose * part.position - Vec3(0, 2, 3)).norm() < 1e-12);
  CHECK(body.inertia.maxCoeff() == Approx(2.0 * (2.0 / 6.0 + 2.0 * 2.25)));
}

TEST_CASE("each face of a surface is a part behind it") {
  const std::string wall = "[[body]]\nshape = \"surface\"\nfile = \"stone.obj\"\nthickness = 0.1\n";
  const Scene scene = scene_of(wall + "motion = {turn = {rate = 2, axis = [0, 3, 0]}}\n");
  const BodySpec& body = scene.bodies.at(0);
  REQUIRE(body.parts.size() == 6);
  double volume = 0.0;
  for (const PlacedShape& part : body.parts) volume += mass_properties(*part.shape).volume;
  CHECK(volume == Approx(0.1 * 22.0));
  REQUIRE(body.imposed);
  CHECK_FALSE(body.can_move());
  CHECK((body.imposed->spin_at(1.0) - Vec3(0, 2, 0)).norm() < 1e-15);
}

TEST_CASE("copies are turned and displaced, and a second table copies the copies") {
  const Scene scene = scene_of(cube +
                               "density = 1\nname = \"stone\"\nposition = [2, 0, 0]\n"
                               "velocity = [1, 0, 0]\n"
                               "[[body.repeat]]\ncount = 4\nangle_degrees = 90\n"
                               "[[body.repeat]]\ncount = 3\ntranslation = [0, 0, 5]\n");
  REQUIRE(scene.bodies.size() == 12);
  CHECK(scene.bodies[6].name == "stone_2_1");
  CHECK((scene.bodies[6].pose.position - Vec3(-2, 0, 5)).norm() < 1e-12);
  CHECK((scene.bodies[6].velocity - Vec3(-1, 0, 0)).norm() < 1e-12);
  CHECK(scene.bodies[6].shape == scene.bodies[0].shape);
}

TEST_CASE("a crowd stands in its space, nowhere near each other, the same for the same seed") {
  const std::string text =
      "[[crowd]]\nname = \"g\"\ncount = 60\nshape = \"grain\"\nradius = 0.1\nradius_min = 0.05\n"
      "density = 1000\nfrom = [-1, 0, 0]\nto = [0, 1, 1]\n";
  const Scene scene = scene_of(text), again = scene_of(text), other = scene_of(text + "seed = 2\n");
  REQUIRE(scene.bodies.size() == 60);
  for (size_t a = 0; a < 60; ++a) {
    const BodySpec& body = scene.bodies[a];
    const double reach = body.shape->circumradius();
    CHECK(reach <= 0.1 + 1e-12);
    CHECK(reach >= 0.05 - 1e-12);
    CHECK((body.pose.position.array() - reach >= Eigen::Array3d(-1, 0, 0)).all());
    CHECK((body.pose.position.array() + reach <= Eigen::Array3d(0, 1, 1)).all());
    CHECK(body.pose.position == again.bodies[a].pose.position);
    for (size_t b = 0; b < a; ++b)
      CHECK((body.pose.position - scene.bodies[b].pose.position).norm() >
            reach + scene.bodies[b].shape->circumradius());
  }
  CHECK(scene.bodies[0].pose.position != other.bodies[0].pose.position);
  CHECK(scene.bodies[3].name == "g_3");
}

TEST_CASE("materials are known by name, whoever names them first") {
  const Scene scene = scene_of("[[wall]]\nnormal = [0, 0, 1]\nmaterial = \"ice\"\n" + cube +
                               "mass = 1\nmaterial = \"steel\"\n[[contact.pair]]\n"
                               "materials = [\"steel\", \"ice\"]\nfriction = 0.02\n");
  REQUIRE(scene.material_pairs.size() == 1);
  CHECK(scene.material_pairs[0].a == scene.bodies[0].material);
  CHECK(scene.material_pairs[0].b == scene.walls[0].material);
}

TEST_CASE("what cannot be is refused by one line") {
  const TemporaryFolder folder;
  const auto says = [&](const std::string& text, const char* words) {
    CHECK_THAT(error_of(folder, text), Contains(words));
  };
  const std::string part = "[[body.part]]\nshape = \"box\"\nsize = [1, 1, 1]\n";
  const std::string crowd =
      "[[crowd]]\ncount = 9\nshape = \"box\"\nradius = 0.25\ndensity = 1\nfrom = [0, 0, 0]\n";
  says(cube + "mass = 1\n" + part, "given together with shape");
  says("[[body]]\nmass = 1\npart = []\n", "at least one");
  says(cube +
           "mass = 1\n[body.motion]\nvelocity = [1, 0, 0]\n[[body.repeat]]\ncount = 2\n"
           "angle_degrees = 10\n",
       "turns a body with a motion");
  says(cube +
           "mass = 1\nvelocity = [1, 0, 0]\nlocked = [\"y\"]\n[[body.repeat]]\ncount = 2\n"
           "angle_degrees = 90\n",
       "turns a velocity into a locked direction");
  says(cube + "velocity = [1, 0, 0]\nmotion = {}\n", "given together with motion");
  says(cube + "motion = {}\nforce = {constant = [1, 0, 0]}\n", "given together with motion");
  says(cube + "motion = {table = [[1, 0, 0, 0], [1, 1, 0, 0]]}\n", "row 1 is not later");
  says(cube + "mass = 1\nname = \"a\"\n" + cube + "mass = 1\nname = \"a\"\n", "given twice");
  says(crowd + "to = [1, 1, 1]\n", "1 bodies have room");
  says(crowd + "to = [2, 2, 2]\nradius_min = 1\n", "larger than radius");
  says(crowd + "to = [2, 2, 2]\naspect = [1e-12, 1, 1]\n", "crowd.0.shape = \"box\"");
  // The region has more cells than an integer can count.
  const auto wide = folder.write("wide.toml", crowd + "to = [1e30, 1e30, 1e30]\n");
  CHECK(read_scene(wide).bodies.size() == 9);
  says("[[body]]\nmass = 1\nshape = \"mesh\"\nfile = \"\"\n", "body.0.file = \"\": is empty");
  says(one_wall + "[[contact.pair]]\nmaterials = [\"a\", \"b\"]\nfriction = 1\n",
       "nothing is made of \"a\"");
  says(one_wall + "material = \"a\"\n[[contact.pair]]\nmaterials = [\"a\"]\nfriction = 1\n",
       "two names");
  says(one_wall + "motion = \"prescribed\"\n", "expected velocity, amplitude or table");
  says("[scene]\nperiod = [0, 0, 3]\n" + one_wall, "not across scene.period");
  says("[scene]\nperiod = [3, 0, 0]\n" + cube + "mass = 1\n", "not smaller than half");
  says("[[body]]\nshape = \"hull\"\nmass = 1\npoints = [[0, 0, 0], [1, 0, 0], [0, 1, 0]]\n",
       "body.0.shape");
}
