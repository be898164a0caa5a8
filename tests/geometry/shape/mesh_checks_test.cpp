// Every kind of defect is refused by name; thin, stretched and far away solids are not.

#include "geometry/shape/mesh_checks.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "geometry/shape/grain_shapes.hpp"
#include "geometry/shape/random_direction.hpp"
#include "tests/catch.hpp"
#include "tests/geometry/shape/loops_of.hpp"

using namespace ballast;

namespace {

using Faces = std::vector<std::vector<int>>;

std::vector<Vec3> vertices_of(const Polyhedron& p) {
  return {p.vertices().begin(), p.vertices().end()};
}

/// The complaint about a mesh; empty when it is accepted.
std::string complaint(const std::vector<Vec3>& vertices, const Faces& faces) {
  try {
    Polyhedron polyhedron(vertices, faces);
    return "";
  } catch (const InvalidPolyhedron& error) {
    return error.what();
  }
}

bool contains(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

const std::vector<Vec3> kTetrahedron = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
const Faces kTetrahedronFaces = {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {0, 3, 2}};

/// Appends a second mesh to the first.
void append(std::vector<Vec3>& vertices, Faces& faces, const Polyhedron& other, const Vec3& shift) {
  const int first = static_cast<int>(vertices.size());
  for (const Vec3& p : other.vertices()) vertices.push_back(p + shift);
  for (std::vector<int> face : loops_of(other)) {
    for (int& v : face) v += first;
    faces.push_back(face);
  }
}

}  // namespace

TEST_CASE("the tetrahedron of the defect table is sound") {
  CHECK(complaint(kTetrahedron, kTetrahedronFaces) == "");
}

TEST_CASE("defects of faces and vertices are named") {
  std::vector<Vec3> v = kTetrahedron;
  Faces f = kTetrahedronFaces;
  std::string expected;
  SECTION("NaN") {
    v[2].y() = std::nan("");
    expected = "vertex 2 has a coordinate that is NaN";
  }
  SECTION("infinity") {
    v[3].z() = std::numeric_limits<double>::infinity();
    expected = "vertex 3 has a coordinate";
  }
  SECTION("overflow") {
    v[3].z() = 1e200;
    expected = "too large";
  }
  SECTION("three vertices") {
    v.pop_back();
    f = {{0, 1, 2}, {2, 1, 0}};
    expected = "at least 4 vertices, got 3";
  }
  SECTION("one point") {
    v.assign(4, Vec3(1, 1, 1));
    expected = "all vertices coincide";
  }
  SECTION("index too large") {
    f[1][1] = 4;
    expected = "face 1 names vertex 4 of 4";
  }
  SECTION("index negative") {
    f[2][0] = -1;
    expected = "face 2 names vertex -1";
  }
  SECTION("face of two") {
    f[3].pop_back();
    expected = "face 3 has 2 vertices";
  }
  SECTION("vertex twice in a face") {
    f[0][1] = 0;
    expected = "face 0 passes through vertex 0 twice";
  }
  SECTION("unused vertex") {
    v.push_back({5, 5, 5});
    expected = "vertex 4 belongs to no face";
  }
  SECTION("no faces") {
    f.clear();
    expected = "vertex 0 belongs to no face";
  }
  SECTION("vertices coincide") {
    v.push_back(v[3] + Vec3(1e-10, 0, 0));
    f = {{0, 2, 1}, {0, 1, 3}, {1, 2, 4}, {1, 4, 3}, {0, 3, 4, 2}};
    expected = "vertices 3 and 4 coincide";
  }
  SECTION("flat") {
    v[3] = {0.3, 0.3, 0};
    expected = "flat: it encloses no volume";
  }
  SECTION("needle") {
    v[2] = {2, 1e-12, 0};
    expected = "face 0 has no area";
  }
  const std::string said = complaint(v, f);
  CAPTURE(said);
  CHECK(contains(said, expected));
}

TEST_CASE("defects of the surface are named") {
  std::vector<Vec3> v = kTetrahedron;
  Faces f = kTetrahedronFaces;
  std::string expected;
  SECTION("open") {
    f.pop_back();
    expected = "the mesh is open at edge 0-2: only face 0 has it";
  }
  SECTION("one face turned over") {
    std::reverse(f[2].begin(), f[2].end());
    expected = "run along edge 1-2 in the same direction";
  }
  SECTION("a face twice") {
    f.push_back(f[2]);
    expected = "edge 1-2 is shared by 3 faces";
  }
  SECTION("inward") {
    for (auto& face : f) std::reverse(face.begin(), face.end());
    expected = "turned inward";
  }
  SECTION("two pieces") {
    append(v, f, Polyhedron(v, f), {3, 0, 0});
    expected = "several pieces: face 4 ";
  }
  SECTION("two tetrahedra at one vertex") {
    v = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {-1, 0, 0}, {0, -1, 0}, {0, 0, -1}};
    f = {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {0, 3, 2}, {0, 4, 5}, {0, 6, 4}, {4, 6, 5}, {0, 5, 6}};
    expected = "several pieces";
  }
  SECTION("a ring") {
    // three bars around a triangular hole, their outer and inner corners in two planes
    v.clear();
    f.clear();
    for (const double z : {0.0, 1.0})
      for (const double r : {1.0, 3.0})
        for (int k = 0; k < 3; ++k)
          v.push_back({r * std::cos(2.0943951 * k), r * std::sin(2.0943951 * k), z});
    for (int k = 0; k < 3; ++k) {
      const int n =
          (k + 1) % 3;  // inner bottom 0-2, outer bottom 3-5, inner top 6-8, outer top 9-11
      f.insert(f.end(), {{3 + k, 3 + n, 9 + n, 9 + k},
                         {k, 6 + k, 6 + n, n},
                         {6 + k, 9 + k, 9 + n, 6 + n},
                         {k, n, 3 + n, 3 + k}});
    }
    expected = "vertices - edges + faces = 0 instead of 2";
  }
  const std::string said = complaint(v, f);
  CAPTURE(said);
  CHECK(contains(said, expected));
}

TEST_CASE("defects of the shape are named") {
  const Polyhedron box = make_box({2, 2, 2});
  std::vector<Vec3> v = vertices_of(box);
  Faces f = loops_of(box);
  std::string expected;
  SECTION("face not flat") {
    v[7] += Vec3(0.1, 0.1, 0.1);
    expected = "is not flat: vertex";
  }
  SECTION("dent") {
    v.push_back({0, 0, 0.5});  // below the middle of the top
    f.pop_back();
    f.insert(f.end(), {{4, 5, 8}, {5, 7, 8}, {7, 6, 8}, {6, 4, 8}});
    expected = "not convex: vertex";
  }
  SECTION("straight corner") {
    v.push_back({0, -1, -1});  // the middle of the edge 0-1
    f[2] = {0, 8, 1, 5, 4};
    f[4] = {0, 2, 3, 1, 8};
    expected = "face 2 is not strictly convex at vertex 8";
  }
  SECTION("star-shaped face") {
    v.clear();
    for (const double z : {-1.0, 1.0})
      for (int k = 0; k < 5; ++k)
        v.push_back({std::cos(1.2566370614359172 * k), std::sin(1.2566370614359172 * k), z});
    f = {{0, 3, 1, 4, 2}, {5, 7, 9, 6, 8}};
    for (int k = 0; k < 5; ++k) f.push_back({k, (k + 2) % 5, 5 + (k + 2) % 5, 5 + k});
    expected = "winds around itself";
  }
  const std::string said = complaint(v, f);
  CAPTURE(said);
  CHECK(contains(said, expected));
}

TEST_CASE("dents count relative to the size, wherever the mesh lies") {
  const std::vector<Vec3> corners = vertices_of(make_box({2, 2, 2}));
  Faces fan = loops_of(make_box({2, 2, 2}));
  fan.pop_back();
  fan.insert(fan.end(), {{4, 5, 8}, {5, 7, 8}, {7, 6, 8}, {6, 4, 8}});
  for (const double scale : {1e-6, 1.0, 1e6}) {
    for (const double shift : {0.0, 100.0}) {
      const auto with_top = [&](double z) {
        std::vector<Vec3> v = corners;
        v.push_back({0.1, 0.2, z});
        for (Vec3& p : v) p = scale * (p + Vec3(shift, -shift, shift));
        return complaint(v, fan);
      };
      CHECK(with_top(1.1) == "");
      CHECK(with_top(1.0 - 1e-10) == "");
      CHECK(contains(with_top(1.0 - 1e-7), "not convex"));
    }
  }
}

TEST_CASE("thin and stretched grains are accepted") {
  Random random(11);
  for (int seed = 0; seed < 300; ++seed) {
    const Polyhedron grain = make_grain({}, 1.0, seed).shape;
    const double thinness = std::pow(10.0, -random.uniform(1.0, 6.0));
    const Quat turn = random_rotation(random);
    std::vector<Vec3> v = vertices_of(grain);
    for (Vec3& p : v) p = turn * p.cwiseProduct(Vec3(1.0, 0.5, thinness)) + Vec3(3, 4, 5);
    CAPTURE(seed, thinness);
    CHECK(complaint(v, loops_of(grain)) == "");
  }
}

TEST_CASE("a vertex in front of a face is measured from that face") {
  const std::vector<Vec3> vertices = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0.2, 0.2, 0.5}};
  const std::vector<Vec3> up = {Vec3::UnitZ()};
  const std::vector<int> first = {0};
  const auto check = [&](double allowed) {
    mesh_checks::check_convex(vertices, first, up, std::vector<double>{allowed}, 2.0);
  };
  CHECK_NOTHROW(check(0.5));
  CHECK_THROWS_WITH(check(0.49), "not convex: vertex 3 lies 0.25 of the size in front of face 0");
}
