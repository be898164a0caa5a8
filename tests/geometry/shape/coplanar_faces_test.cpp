// Joined faces, and the hull made of them beside qhull's.

#include "geometry/shape/coplanar_faces.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>

#include "geometry/shape/convex_hull.hpp"
#include "geometry/shape/mass_properties.hpp"
#include "geometry/shape/random_direction.hpp"
#include "tests/catch.hpp"

using namespace ballast;

namespace {

struct Mesh {
  std::vector<Vec3> vertices;
  std::vector<std::vector<int>> faces;
};

/// Every face cut into a fan of triangles.
Mesh in_triangles(const Polyhedron& p) {
  Mesh mesh{{p.vertices().begin(), p.vertices().end()}, {}};
  for (int f = 0; f < p.face_count(); ++f)
    for (size_t k = 2; k < p.face(f).size(); ++k)
      mesh.faces.push_back({p.face(f)[0], p.face(f)[k - 1], p.face(f)[k]});
  return mesh;
}

/// Every triangle cut into four at the middles of its edges.
Mesh subdivided(const Mesh& coarse) {
  Mesh mesh{coarse.vertices, {}};
  std::map<std::pair<int, int>, int> middles;
  const auto middle = [&](int a, int b) {
    const auto [at, is_new] =
        middles.try_emplace(std::minmax(a, b), static_cast<int>(mesh.vertices.size()));
    if (is_new) mesh.vertices.push_back(0.5 * (coarse.vertices[a] + coarse.vertices[b]));
    return at->second;
  };
  for (const std::vector<int>& face : coarse.faces) {
    const int a = face[0], b = face[1], c = face[2];
    const int ab = middle(a, b), bc = middle(b, c), ca = middle(c, a);
    for (const std::array<int, 3>& part : {std::array{a, ab, ca}, std::array{ab, b, bc},
                                           std::array{ca, bc, c}, std::array{ab, bc, ca}})
      mesh.faces.emplace_back(part.begin(), part.end());
  }
  return mesh;
}

void check_same_bits(const Polyhedron& p, const Polyhedron& q) {
  REQUIRE(p.vertex_count() == q.vertex_count());
  REQUIRE(p.face_count() == q.face_count());
  CHECK(std::ranges::equal(p.vertices(), q.vertices()));
  CHECK(std::ranges::equal(p.normals(), q.normals()));
  for (int f = 0; f < p.face_count(); ++f) {
    CHECK(std::ranges::equal(p.face(f), q.face(f)));
    CHECK(p.offset(f) == q.offset(f));
  }
}

/// A box with cut corners, or the hull of random points, or of points on a few planes; turned.
std::vector<Vec3> some_points(int trial, Random& random) {
  const Quat turn = trial % 2 ? random_rotation(random) : Quat::Identity();
  std::vector<Vec3> points;
  for (int i = 0; i < 8 + trial; ++i) {
    Vec3 p = random_direction(random).cwiseProduct(Vec3(3, 2, 1));
    if (trial % 3 == 1) p = p.cwiseMin(0.7).cwiseMax(-0.7);
    if (trial % 3 == 2) p = (4.0 * p).array().round() / 4.0;
    points.push_back(turn * p);
  }
  return points;
}

}  // namespace

TEST_CASE("joined faces are the hull that qhull makes, bit for bit") {
  Random random(21);
  int joined = 0;
  for (int trial = 0; trial < 60; ++trial) {
    Mesh mesh = in_triangles(convex_hull(some_points(trial, random)));
    for (int times = 0; times < trial % 4; ++times) mesh = subdivided(mesh);
    // In any order: the numbers of faces say nothing.
    for (size_t f = mesh.faces.size(); f > 1; --f)
      std::swap(mesh.faces[f - 1], mesh.faces[random.below(f)]);
    const Polyhedron cut(mesh.vertices, mesh.faces);
    const std::optional<Loops> loops = joined_faces(cut, coplanar_groups(cut, 2e-10), 4e-9);
    const Polyhedron expected = convex_hull(mesh.vertices);
    REQUIRE(loops);
    CHECK(static_cast<int>(loops->size()) == expected.face_count());
    size_t corners = 0, expected_corners = 0;
    for (const auto& loop : *loops) corners += loop.size();
    for (int f = 0; f < expected.face_count(); ++f) expected_corners += expected.face(f).size();
    CHECK(corners == expected_corners);
    check_same_bits(convex_hull_of_mesh(cut), expected);
    joined += cut.face_count() > expected.face_count();
  }
  CHECK(joined > 40);
}

TEST_CASE("faces that are only just coplanar make the same solid to the tolerance") {
  Random random(22);
  int compared = 0;
  for (int trial = 0; trial < 60; ++trial) {
    Mesh mesh = subdivided(subdivided(in_triangles(convex_hull(some_points(trial, random)))));
    // By 1e-12 to 1e-9: what qhull would join or drop, and what it would not.
    const double rough = 1e-12 * std::pow(10.0, trial % 4);
    for (Vec3& p : mesh.vertices) p += random.uniform(0.0, rough) * random_direction(random);
    try {
      const Polyhedron cut(mesh.vertices, mesh.faces);
      const Polyhedron fast = convex_hull_of_mesh(cut), slow = convex_hull(mesh.vertices);
      const MassProperties a = mass_properties(fast), b = mass_properties(slow);
      CHECK(a.volume == Approx(b.volume).epsilon(1e-8));
      CHECK((a.centre - b.centre).norm() < 1e-8);
      CHECK((a.inertia - b.inertia).norm() < 1e-7 * b.inertia.norm());
      double highest = 0.0;
      for (const Vec3& p : mesh.vertices)
        for (int f = 0; f < fast.face_count(); ++f)
          highest = std::max(highest, fast.normal(f).dot(p) - fast.offset(f));
      CHECK(highest < 2e-8);
      ++compared;
    } catch (const InvalidPolyhedron&) {
      // Rougher than a mesh with small faces may be.
    }
  }
  CHECK(compared > 30);
}

TEST_CASE("what does not join to a solid is left to qhull") {
  const Polyhedron box = make_box(Vec3(1, 2, 3));
  CHECK(joined_faces(box, coplanar_groups(box, 1e-9), 1e-9)->size() == 6);
  // All faces in one group, and two groups whose rim has no third.
  CHECK_FALSE(joined_faces(box, coplanar_groups(box, 10.0), 1e-9));
  CHECK_FALSE(joined_faces(box, coplanar_groups(box, 1.0), 1e-9));
  // A vertex on an edge that bulges: joined only where that may be passed over.
  Mesh mesh = subdivided(in_triangles(box));
  int moved = 0;
  for (Vec3& p : mesh.vertices)
    if (p.x() == 0.5 && p.y() == 1.0 && p.z() == 0.0) {
      p += Vec3(1e-6, 1e-6, 0.0);
      ++moved;
    }
  REQUIRE(moved == 1);
  mesh = in_triangles(convex_hull(mesh.vertices));
  const Polyhedron bulging(mesh.vertices, mesh.faces);
  CHECK(joined_faces(bulging, coplanar_groups(bulging, 1e-5), 1e-5)->size() == 6);
  CHECK_FALSE(joined_faces(bulging, coplanar_groups(bulging, 1e-5), 1e-7));
  check_same_bits(convex_hull_of_mesh(bulging), convex_hull(mesh.vertices));
}
