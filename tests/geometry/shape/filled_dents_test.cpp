#include "geometry/shape/filled_dents.hpp"

#include <algorithm>
#include <numbers>

#include "geometry/shape/convex_hull.hpp"
#include "geometry/shape/random_direction.hpp"
#include "tests/catch.hpp"
#include "tests/support/uv_sphere.hpp"

using namespace ballast;

namespace {

/// Faces by the points themselves: two numberings are compared.
std::vector<std::vector<std::array<double, 3>>> faces_by_place(const Polyhedron& solid) {
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
    CHECK(faces_by_place(solid_of(mesh.vertices(), *loops)) == faces_by_place(hull));
  }
}

TEST_CASE("filled dents: a convex mesh stays as it is") {
  Random random(12);
  std::vector<Vec3> points(300);
  for (Vec3& p : points) p = random_direction(random);
  const Polyhedron hull = convex_hull(points);
  const std::optional<Loops> loops = filled_dents(hull);
  REQUIRE(loops);
  CHECK(faces_by_place(solid_of(hull.vertices(), *loops)) == faces_by_place(hull));
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

TEST_CASE("filled dents: crumpled meshes, whose surface passes through itself") {
  // The hull, or what shows that it is none: nothing, loops that are no solid, points outside.
  Random random(13);
  int hulls = 0;
  for (int trial = 1; trial < 300; ++trial) {
    INFO(trial);
    const Polyhedron mesh = dented(make_uv_sphere(8, 10), 0.002 * trial, random);
    const std::optional<Loops> loops = filled_dents(mesh);
    if (!loops) continue;
    try {
      const Polyhedron solid = solid_of(mesh.vertices(), *loops);
      bool is_within = true;
      for (int f = 0; f < solid.face_count(); ++f)
        for (const Vec3& p : mesh.vertices())
          is_within &= solid.normal(f).dot(p) <= solid.offset(f) + 1e-12;
      if (!is_within) continue;
      CHECK(faces_by_place(solid) == faces_by_place(convex_hull(mesh.vertices())));
      ++hulls;
    } catch (const InvalidPolyhedron&) {
      continue;
    }
  }
  CHECK(hulls > 80);
}

TEST_CASE("filled dents: faces of more corners are cut") {
  // A prism over a heptagon, with one corner of its lid pressed down: three triangles stay there.
  std::vector<Vec3> points;
  std::vector<std::vector<int>> faces(2);
  for (int k = 0; k < 7; ++k) {
    const double angle = k * 2.0 * std::numbers::pi / 7;
    points.emplace_back(std::cos(angle), std::sin(angle), 1.0);
    points.emplace_back(std::cos(angle), std::sin(angle), -1.0);
    faces[0].push_back(2 * k);
    faces[1].insert(faces[1].begin(), 2 * k + 1);
    const int next = 2 * ((k + 1) % 7);
    faces.push_back({2 * k, 2 * k + 1, next + 1, next});
  }
  points[6][2] -= 1e-3;
  const Polyhedron mesh(points, faces, 1e-2);
  const std::optional<Loops> loops = filled_dents(mesh);
  REQUIRE(loops);
  CHECK(loops->size() == 5 + 5 + 7 * 2);
  const Polyhedron solid = solid_of(mesh.vertices(), *loops);
  CHECK(faces_by_place(convex_hull_of_mesh(solid)) == faces_by_place(convex_hull(points)));
}
