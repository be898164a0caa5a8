#include "geometry/shape/filled_dents.hpp"

#include <algorithm>
#include <numeric>

#include "geometry/shape/convex_hull.hpp"
#include "geometry/shape/random_direction.hpp"
#include "tests/catch.hpp"
#include "tests/support/uv_sphere.hpp"

using namespace ballast;

namespace {

/// Faces by the points themselves: two numberings are compared.
std::vector<std::vector<std::array<double, 3>>> faces_of(const Polyhedron& solid) {
  std::vector<std::vector<std::array<double, 3>>> faces;
  for (int f = 0; f < solid.face_count(); ++f) {
    auto& face = faces.emplace_back();
    for (const int v : solid.face(f))
      face.push_back({solid.vertex(v)[0], solid.vertex(v)[1], solid.vertex(v)[2]});
    std::rotate(face.begin(), std::min_element(face.begin(), face.end()), face.end());
  }
  std::sort(faces.begin(), faces.end());
  return faces;
}

/// With each vertex moved by up to `most` along each axis; a mesh that is closed, but not convex.
Polyhedron dented(const UvSphere& sphere, double most, Random& random) {
  std::vector<Vec3> points = sphere.vertices;
  for (Vec3& p : points)
    for (double& x : p) x += most * (2.0 * random.uniform() - 1.0);
  return Polyhedron(points, sphere.faces, 1e-9, 1.0);
}

}  // namespace

TEST_CASE("filled dents: the hull of the points, where neighbours are bent either way") {
  Random random(11);
  for (const double most : {1e-4, 1e-3, 5e-3}) {
    INFO(most);
    const Polyhedron mesh = dented(make_uv_sphere(24, 40), most, random);
    const Polyhedron hull = convex_hull(mesh.vertices());
    const std::optional<Loops> loops = filled_dents(mesh);
    REQUIRE(loops);
    // Of 4e-3 the middle of an edge lies below the sphere: corners lie within from there on.
    CHECK((loops->size() < static_cast<size_t>(mesh.face_count())) == (most > 3e-4));
    CHECK(faces_of(solid_of(mesh.vertices(), *loops)) == faces_of(hull));
  }
}

TEST_CASE("filled dents: a convex mesh stays as it is") {
  Random random(12);
  std::vector<Vec3> points(300);
  for (Vec3& p : points) p = random_direction(random);
  const Polyhedron hull = convex_hull(points);
  const std::optional<Loops> loops = filled_dents(hull);
  REQUIRE(loops);
  CHECK(faces_of(solid_of(hull.vertices(), *loops)) == faces_of(hull));
}

TEST_CASE("filled dents: a deep dent, filled step by step") {
  // A bowl of many rings around the north pole: its corners all go.
  UvSphere bowl = make_uv_sphere(60, 24);
  int kept = 0;
  for (Vec3& p : bowl.vertices) {
    if (p[2] > 0.9) p[2] = 1.8 - p[2];
    kept += p.norm() > 0.999;
  }
  const Polyhedron mesh(bowl.vertices, bowl.faces, 1e-9, 1.0);
  const std::optional<Loops> loops = filled_dents(mesh);
  REQUIRE(loops);
  CHECK(solid_of(mesh.vertices(), *loops).vertex_count() == kept);
}

TEST_CASE("filled dents: triangles only") { CHECK(!filled_dents(make_box(Vec3::Ones()))); }
