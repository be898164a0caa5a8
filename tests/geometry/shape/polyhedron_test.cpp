#include "geometry/shape/polyhedron.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>
#include <vector>

#include "geometry/shape/grain_shapes.hpp"
#include "geometry/shape/point_sets.hpp"
#include "geometry/shape/pose.hpp"
#include "tests/catch.hpp"
#include "tests/support/complaint.hpp"

using namespace ballast;

namespace {

/// Checks all lists of the polyhedron against a search through its faces.
void check_topology(const Polyhedron& p) {
  REQUIRE(p.vertex_count() - p.edge_count() + p.face_count() == 2);
  std::set<std::pair<int, int>> directed;
  std::vector<std::set<int>> touching(p.vertex_count());
  for (int f = 0; f < p.face_count(); ++f) {
    const auto loop = p.face(f);
    for (size_t k = 0; k < loop.size(); ++k) {
      const int a = loop[k], b = loop[(k + 1) % loop.size()];
      REQUIRE(directed.insert({a, b}).second);
      touching[a].insert(f);
      const auto across = p.face(p.face_neighbours(f)[k]);
      const auto at = std::find(across.begin(), across.end(), b) - across.begin();
      CHECK(at < static_cast<long>(across.size()));
      CHECK(across[(at + 1) % across.size()] == a);
    }
  }
  REQUIRE(p.edges().size() == static_cast<size_t>(p.edge_count()));
  REQUIRE(directed.size() == 2 * p.edges().size());
  for (const auto& edge : p.edges()) {
    CHECK(edge.tail < edge.head);
    for (const auto& [face, from, to] : {std::tuple(edge.left, edge.tail, edge.head),
                                         std::tuple(edge.right, edge.head, edge.tail)}) {
      const auto loop = p.face(face);
      const auto at = std::find(loop.begin(), loop.end(), from) - loop.begin();
      CHECK(loop[(at + 1) % loop.size()] == to);
    }
  }
  const std::vector<std::vector<int>> by_vertex = p.faces_by_vertex();
  for (int v = 0; v < p.vertex_count(); ++v)
    CHECK(by_vertex[v] == std::vector<int>(touching[v].begin(), touching[v].end()));
}

}  // namespace

TEST_CASE("a box has exact planes, radii and all neighbours") {
  const Polyhedron box = make_box({2.0, 4.0, 6.0});
  REQUIRE(box.vertex_count() == 8);
  REQUIRE(box.edge_count() == 12);
  REQUIRE(box.face_count() == 6);
  check_topology(box);
  for (int f = 0; f < 6; ++f) {
    const int axis = f / 2;
    CHECK(box.normal(f) == (f % 2 ? 1.0 : -1.0) * Vec3::Unit(axis));
    CHECK(box.offset(f) == axis + 1.0);
    CHECK(box.face(f).size() == 4);
  }
  CHECK(box.inradius() == 1.0);
  CHECK(box.circumradius() == Approx(std::sqrt(14.0)).epsilon(1e-15));
  CHECK_THROWS_AS(make_box({1.0, 0.0, 1.0}), InvalidPolyhedron);
  CHECK_THROWS_AS(make_box({1.0, std::nan(""), 1.0}), InvalidPolyhedron);
}

TEST_CASE("topology of grains agrees with a search through the faces") {
  for (int seed = 0; seed < 50; ++seed) check_topology(make_grain({}, 0.02, seed).shape);
  check_topology(make_sphere(1.0, 3));
}

TEST_CASE("the inradius is negative when the origin lies outside") {
  const auto tetrahedron = [](double z) {
    return Polyhedron({{0, 0, z}, {1, 0, z}, {0, 1, z}, {0, 0, z + 1}},
                      {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {0, 3, 2}});
  };
  CHECK(tetrahedron(2.0).inradius() == Approx(-2.0));
  CHECK(tetrahedron(0.0).inradius() == 0.0);
}

TEST_CASE("the area vector of a polygon is twice its area along its normal") {
  // An L of three unit squares in the plane z = 7, counter-clockwise from above.
  const std::vector<Vec3> points{{0, 0, 7}, {2, 0, 7}, {2, 1, 7}, {1, 1, 7}, {1, 2, 7}, {0, 2, 7}};
  CHECK(area_vector(std::vector<int>{0, 1, 2, 3, 4, 5}, points) == Vec3(0, 0, 6));
  CHECK(area_vector(std::vector<int>{5, 4, 3, 2, 1, 0}, points) == Vec3(0, 0, -6));
}

TEST_CASE("a polyhedron with other vertices keeps its faces") {
  const Polyhedron box = make_box({1, 2, 3});
  std::vector<Vec3> moved;
  for (const Vec3& p : box.vertices()) moved.push_back(2.0 * p + Vec3(1, 0, 0));
  const Polyhedron other = box.with_vertices(moved);
  CHECK(other.offset(1) == Approx(2.0));
  for (int f = 0; f < box.face_count(); ++f) {
    CHECK(std::vector<int>(other.face(f).begin(), other.face(f).end()) ==
          std::vector<int>(box.face(f).begin(), box.face(f).end()));
    CHECK((other.normal(f) - box.normal(f)).norm() < 1e-15);
  }
  // After a reflection all faces look inwards.
  for (Vec3& p : moved) p.x() = -p.x();
  CHECK_THROWS_AS(box.with_vertices(moved), InvalidPolyhedron);
}

TEST_CASE("a polyhedron in another frame is the one made anew from the moved vertices") {
  const Polyhedron box = make_box({1, 2, 3});
  const Mat3 axes = Quat(0.5, -0.1, 0.7, 0.2).normalized().toRotationMatrix();
  const Vec3 origin(4, -5, 6);
  std::vector<Vec3> moved;
  for (const Vec3& p : box.vertices()) moved.push_back(axes.transpose() * (p - origin));
  const Polyhedron seen = box.in_frame(axes, origin), anew = box.with_vertices(moved);
  CHECK(seen.circumradius() == anew.circumradius());
  CHECK(seen.inradius() == anew.inradius());
  for (int v = 0; v < box.vertex_count(); ++v) CHECK(seen.vertex(v) == anew.vertex(v));
  for (int f = 0; f < box.face_count(); ++f) {
    CHECK(seen.normal(f) == anew.normal(f));
    CHECK(seen.offset(f) == anew.offset(f));
    CHECK(seen.normal(f).isApprox(axes.transpose() * box.normal(f), 1e-15));
  }
}

namespace {

using Faces = std::vector<std::vector<int>>;

std::vector<Vec3> vertices_of(const Polyhedron& p) {
  return {p.vertices().begin(), p.vertices().end()};
}

/// The faces of a solid as lists of its vertices, in the form of a mesh.
Faces loops_of(const Polyhedron& solid) {
  Faces loops;
  for (int f = 0; f < solid.face_count(); ++f)
    loops.emplace_back(solid.face(f).begin(), solid.face(f).end());
  return loops;
}

/// The defect for which a mesh is refused; empty if it is accepted.
std::string defect(const std::vector<Vec3>& vertices, const Faces& faces) {
  return complaint<InvalidPolyhedron>([&] { Polyhedron(vertices, faces); });
}

const std::vector<Vec3> corner_points = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
const Faces corner_faces = {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {0, 3, 2}};

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

TEST_CASE("defects are named") {
  REQUIRE(defect(corner_points, corner_faces) == "");
  const std::vector<Vec3> box = vertices_of(make_box({2, 2, 2}));
  const Faces box_faces = loops_of(make_box({2, 2, 2}));
  std::vector<Vec3> v;
  Faces f;
  const auto refuses = [&](const std::string& expected, const auto& change) {
    v = corner_points;
    f = corner_faces;
    change();
    CHECK_THAT(defect(v, f), Catch::Contains(expected));
  };
  refuses("vertex 2 has a coordinate that is NaN", [&] { v[2].y() = std::nan(""); });
  refuses("vertex 3 has a coordinate", [&] { v[3].z() = std::numeric_limits<double>::infinity(); });
  refuses("too large", [&] { v[3].z() = 1e200; });
  refuses("at least 4 vertices, got 3", [&] {
    v.pop_back();
    f = {{0, 1, 2}, {2, 1, 0}};
  });
  refuses("all vertices coincide", [&] { v.assign(4, Vec3(1, 1, 1)); });
  refuses("face 1 names vertex 4 of 4", [&] { f[1][1] = 4; });
  refuses("face 2 names vertex -1", [&] { f[2][0] = -1; });
  refuses("vertex 0 belongs to no face", [&] { f.clear(); });
  refuses("vertices 3 and 4 coincide", [&] {
    v.push_back(v[3] + Vec3(1e-10, 0, 0));
    f = {{0, 2, 1}, {0, 1, 3}, {1, 2, 4}, {1, 4, 3}, {0, 3, 4, 2}};
  });
  refuses("face 0 has no area", [&] { v[2] = {2, 1e-12, 0}; });
  refuses("several pieces: face 4 ", [&] { append(v, f, Polyhedron(v, f), {3, 0, 0}); });
  refuses("several pieces", [&] {
    v = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {-1, 0, 0}, {0, -1, 0}, {0, 0, -1}};
    f = {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {0, 3, 2}, {0, 4, 5}, {0, 6, 4}, {4, 6, 5}, {0, 5, 6}};
  });
  refuses("vertices - edges + faces = 0 instead of 2", [&] {
    // Three bars around a triangular hole, with their outer and inner corners in two planes.
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
  });
  refuses("not convex: vertex", [&] {
    v = box;
    f = box_faces;
    v.push_back({0, 0, 0.5});  // below the middle of the top
    f.pop_back();
    f.insert(f.end(), {{4, 5, 8}, {5, 7, 8}, {7, 6, 8}, {6, 4, 8}});
  });
  refuses("face 2 is not strictly convex at vertex 8", [&] {
    v = box;
    f = box_faces;
    v.push_back({0, -1, -1});  // the middle of the edge 0-1
    f[2] = {0, 8, 1, 5, 4};
    f[4] = {0, 2, 3, 1, 8};
  });
  refuses("winds around itself", [&] {
    v.clear();
    for (const double z : {-1.0, 1.0})
      for (int k = 0; k < 5; ++k)
        v.push_back({std::cos(1.2566370614359172 * k), std::sin(1.2566370614359172 * k), z});
    f = {{0, 3, 1, 4, 2}, {5, 7, 9, 6, 8}};
    for (int k = 0; k < 5; ++k) f.push_back({k, (k + 2) % 5, 5 + (k + 2) % 5, 5 + k});
  });
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
        return defect(v, fan);
      };
      CHECK(with_top(1.1) == "");
      CHECK(with_top(1.0 - 1e-10) == "");
      CHECK_THAT(with_top(1.0 - 1e-7), Catch::Contains("not convex"));
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
    CHECK(defect(v, loops_of(grain)) == "");
  }
}
