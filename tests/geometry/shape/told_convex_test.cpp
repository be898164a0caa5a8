// Convexity told from neighbours alone is what a look at all vertices from all faces finds.

#include <cmath>
#include <numbers>
#include <string>

#include "geometry/shape/convex_hull.hpp"
#include "geometry/shape/mesh_checks.hpp"
#include "geometry/shape/random_direction.hpp"
#include "tests/catch.hpp"

using namespace ballast;

namespace {

/// Two pyramids over one polygon of `corners` corners that goes `turns` times around.
std::vector<std::vector<int>> double_pyramid(int corners, int turns, std::vector<Vec3>& vertices) {
  vertices = {{0, 0, 1}, {0, 0, -1}};
  std::vector<std::vector<int>> faces;
  for (int k = 0; k < corners; ++k) {
    const double angle = 2.0 * std::numbers::pi * turns * k / corners;
    vertices.emplace_back(std::cos(angle), std::sin(angle), 0.0);
    const int a = 2 + k, b = 2 + (k + 1) % corners;
    faces.push_back({0, a, b});
    faces.push_back({1, b, a});
  }
  return faces;
}

/// What is_surely_convex says of the triangles.
bool is_sure(const std::vector<Vec3>& vertices, const std::vector<std::vector<int>>& faces) {
  std::vector<int> corners, across;
  std::vector<Vec3> normals;
  for (const std::vector<int>& face : faces) {
    corners.insert(corners.end(), face.begin(), face.end());
    const Vec3& a = vertices[face[0]];
    normals.push_back((vertices[face[1]] - a).cross(vertices[face[2]] - a).normalized());
    for (int k = 0; k < 3; ++k)
      for (size_t g = 0; g < faces.size(); ++g)
        for (int j = 0; j < 3; ++j)
          if (faces[g][j] == face[(k + 1) % 3] && faces[g][(j + 1) % 3] == face[k])
            across.push_back(static_cast<int>(g));
  }
  const std::vector<double> blur(faces.size(), 1e-14);
  return mesh_checks::is_surely_convex(vertices, corners, across, normals, blur);
}

bool is_refused(const std::vector<Vec3>& vertices, const std::vector<std::vector<int>>& faces) {
  try {
    Polyhedron(vertices, faces);
    return false;
  } catch (const InvalidPolyhedron& error) {
    return std::string(error.what()).find("not convex") != std::string::npos;
  }
}

}  // namespace

TEST_CASE("told from neighbours: once around is convex, twice is not") {
  std::vector<Vec3> vertices;
  std::vector<std::vector<int>> faces = double_pyramid(5, 1, vertices);
  CHECK(is_sure(vertices, faces));
  // The pentagram's: a sphere by Euler's count and bent outward at every edge.
  faces = double_pyramid(5, 2, vertices);
  CHECK_FALSE(is_sure(vertices, faces));
  CHECK(is_refused(vertices, faces));
  // Neighbours in one plane leave it open.
  CHECK_FALSE(is_sure({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {0.5, 0, 0}},
                      {{0, 2, 4}, {4, 2, 1}, {0, 4, 3}, {4, 1, 3}, {1, 2, 3}, {0, 3, 2}}));
}

TEST_CASE("told from neighbours, and by looking at all vertices from all faces: the same") {
  Random random(31);
  int convex = 0, dented = 0;
  for (int trial = 0; trial < 200; ++trial) {
    std::vector<Vec3> points;
    for (int i = 0; i < 8 + trial % 30; ++i) points.push_back(random_direction(random));
    const Polyhedron hull = convex_hull(points);
    std::vector<Vec3> vertices(hull.vertices().begin(), hull.vertices().end());
    std::vector<std::vector<int>> faces;
    for (int f = 0; f < hull.face_count(); ++f)
      faces.emplace_back(hull.face(f).begin(), hull.face(f).end());
    if (trial % 2 == 1) vertices[random.below(vertices.size())] *= random.uniform(0.3, 1.1);
    bool expected = true;
    for (const std::vector<int>& face : faces) {
      const Vec3& a = vertices[face[0]];
      const Vec3 normal = (vertices[face[1]] - a).cross(vertices[face[2]] - a).normalized();
      for (const Vec3& p : vertices) expected = expected && normal.dot(p - a) < 1e-12;
    }
    CHECK(is_sure(vertices, faces) == expected);
    CHECK(is_refused(vertices, faces) != expected);
    (expected ? convex : dented) += 1;
  }
  CHECK(convex > 100);
  CHECK(dented > 40);
}
