#include "geometry/shape/polyhedron.hpp"

#include <algorithm>
#include <cmath>
#include <set>

#include "geometry/shape/grain_shapes.hpp"
#include "tests/catch.hpp"

using namespace ballast;

namespace {

/// All lists of the polyhedron against what a search through its faces says.
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
  REQUIRE(directed.size() == 2 * p.edges().size());
  REQUIRE(directed.size() == 2 * static_cast<size_t>(p.edge_count()));
  for (const auto& edge : p.edges()) {
    CHECK(edge.tail < edge.head);
    for (const auto& [face, from, to] : {std::tuple(edge.left, edge.tail, edge.head),
                                         std::tuple(edge.right, edge.head, edge.tail)}) {
      const auto loop = p.face(face);
      const auto at = std::find(loop.begin(), loop.end(), from) - loop.begin();
      CHECK(loop[(at + 1) % loop.size()] == to);
    }
  }
  const SortedByKey by_vertex = p.faces_by_vertex();
  for (int v = 0; v < p.vertex_count(); ++v) {
    const auto faces = by_vertex.of(v);
    CHECK(std::vector<int>(faces.begin(), faces.end()) ==
          std::vector<int>(touching[v].begin(), touching[v].end()));
  }
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
