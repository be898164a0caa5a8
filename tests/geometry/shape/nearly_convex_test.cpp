#include "geometry/shape/nearly_convex.hpp"

#include <algorithm>
#include <numbers>

#include "geometry/shape/convex_hull.hpp"
#include "platform/random.hpp"
#include "tests/catch.hpp"
#include "tests/support/uv_sphere.hpp"

using namespace ballast;

namespace {

/// A sphere with its north pole moved to this height.
Polyhedron with_pole_at(double height, int rings, int columns) {
  UvSphere sphere = make_uv_sphere(rings, columns);
  sphere.vertices[sphere.vertices.size() - 2] = Vec3(0.0, 0.0, height);
  return Polyhedron(sphere.vertices, sphere.faces, 1e-9, 1.0);
}

}  // namespace

TEST_CASE("nearly convex: a vertex within the hull goes, up to a depth") {
  // The second is of the size that qhull is not asked for.
  for (const auto& [rings, columns] : {std::pair(20, 30), std::pair(100, 120)}) {
    INFO(rings);
    const double rim = std::cos(std::numbers::pi / rings);
    const int vertices = (rings - 1) * columns + 2, pole = vertices - 2;
    CHECK(hull_of_nearly_convex(with_pole_at(1.0, rings, columns), 1e-6).vertex_count() ==
          vertices);
    const Polyhedron hull =
        hull_of_nearly_convex(with_pole_at(rim - 1e-6, rings, columns), 1e-6);  // extent 2
    CHECK(hull.vertex_count() == vertices - 1);
    for (const double depth : {3e-6, 0.5}) try {
        hull_of_nearly_convex(with_pole_at(rim - depth, rings, columns), 1e-6);
        FAIL("taken for convex");
      } catch (const InvalidPolyhedron& error) {
        CHECK(error.vertex == pole);
        CHECK_THAT(error.what(), Catch::Contains("within the hull of the others"));
      }
  }
}

TEST_CASE("nearly convex: a crumpled mesh of many vertices") {
  // Whose surface passes through itself: filling dents loses points that lie outside.
  Random random(14);
  UvSphere sphere = make_uv_sphere(100, 120);
  for (Vec3& p : sphere.vertices)
    for (double& x : p) x += random.uniform(-0.03, 0.03);
  const Polyhedron mesh(sphere.vertices, sphere.faces, 1e-9, 1.0);
  const Polyhedron hull = convex_hull(mesh.vertices());
  const Polyhedron found = hull_of_nearly_convex(mesh, 1.0);
  CHECK(std::ranges::equal(found.vertices(), hull.vertices()));
  CHECK(found.face_count() == hull.face_count());
}
