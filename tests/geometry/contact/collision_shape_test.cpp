#include "geometry/contact/collision_shape.hpp"

#include <algorithm>
#include <cmath>

#include "geometry/shape/convex_hull.hpp"
#include "tests/catch.hpp"
#include "tests/geometry/contact/detection_support.hpp"
#include "tests/geometry/shape/support_vertex.hpp"

using namespace ballast;
using namespace ballast::testing;

TEST_CASE("affine rows are evaluated row by row, padding included") {
  Random random(1);
  for (int count : {1, 4, 8, 9, 37}) {
    AffineRows rows(count, -5.0);
    CHECK(rows.padded() % 8 == 0);
    CHECK(rows.padded() >= count);
    std::vector<Vec3> xyz;
    for (int i = 0; i < count; ++i) {
      xyz.push_back(random_direction(random));
      rows.set(i, xyz.back(), i);
    }
    const Vec3 d = random_direction(random);
    std::vector<double> values(rows.padded());
    rows.evaluate(d, values.data());
    for (int i = 0; i < rows.padded(); ++i)
      CHECK(values[i] == (i < count ? Approx(xyz[i].dot(d) + i).margin(1e-15) : Approx(-5.0)));
  }
}

namespace {

bool face_is_at(const CollisionShape& shape, int vertex, int face) {
  for (int k = 0; k < shape.vertex_face_count(vertex); ++k)
    if (shape.vertex_face(vertex, k) == face) return true;
  return false;
}

}  // namespace

TEST_CASE("tables agree with the polyhedron they come from") {
  for (size_t s = 0; s < shape_pool().size(); ++s) {
    const Polyhedron& polyhedron = shape_pool()[s];
    const CollisionShape& shape = collision_pool()[s];
    const double small = 1e-14;
    REQUIRE(shape.vertices().count() == polyhedron.vertex_count());
    const int vertices = shape.vertices().count(), edges = shape.edge_count();
    CHECK(vertices - edges + shape.faces().count() == 2);
    CHECK(shape.bounds().planarity_error <= small);
    for (int f = 0; f < shape.faces().count(); ++f) {
      const Vec3 normal = shape.faces().xyz(f);
      CHECK(normal.norm() == Approx(1.0).epsilon(1e-14));
      CHECK(-shape.faces().w(f) ==
            Approx(normal.dot(support_vertex(polyhedron, normal))).epsilon(1e-13));
      CHECK(normal.dot(shape.bounds().ball_centre) + shape.faces().w(f) <=
            -shape.bounds().ball_radius + small);
      for (int k = 0; k < shape.corner_count(f); ++k) {
        const std::uint16_t corner = shape.corner(f, k).vertex,
                            next = shape.corner(f, (k + 1) % shape.corner_count(f)).vertex;
        const CollisionShape::Side side = shape.side(f, k);
        const CollisionShape::Edge edge = shape.edge(shape.corner(f, k).edge);
        CHECK(std::minmax(corner, next) == std::minmax(edge.tail, edge.head));
        CHECK((edge.left == f ? edge.tail : edge.head) == corner);
        CHECK((edge.left == f || edge.right == f));
        CHECK(std::abs(side.outward.dot(normal)) <= small);
        for (const auto& [v, e, p] : face_table(shape, f).corners)
          CHECK(side.outward.dot(shape.vertices().xyz(v)) - side.offset <= small);
        CHECK(face_is_at(shape, corner, f));
      }
    }
    CHECK(shape.bounds().ball_radius > 0.0);
  }
}

TEST_CASE("an edge between two faces in one plane bounds no depth") {
  const Polyhedron box = make_box(Vec3(1, 2, 3));
  std::vector<std::vector<int>> triangles;
  for (int f = 0; f < box.face_count(); ++f) {
    const auto c = box.face(f);
    triangles.push_back({c[0], c[1], c[2]});
    triangles.push_back({c[0], c[2], c[3]});
  }
  const Polyhedron split({box.vertices().begin(), box.vertices().end()}, triangles);
  // The box is turned, so that faces are coplanar only up to rounding.
  Random random(3);
  const Quat rotation = random_rotation(random);
  std::vector<Vec3> vertices;
  for (const Vec3& p : split.vertices()) vertices.push_back(rotation * p);
  const CollisionShape shape(split.with_vertices(vertices));
  REQUIRE(shape.edge_count() == 18);
  int diagonals = 0;
  for (int e = 0; e < shape.edge_count(); ++e) {
    const CollisionShape::Edge edge = shape.edge(e);
    const bool is_diagonal = edge.left_normal.dot(edge.right_normal) > 0.5;
    diagonals += is_diagonal;
    CHECK((edge.drop == 0.0f) == is_diagonal);
  }
  CHECK(diagonals == 6);
  CHECK(CollisionShape(convex_hull(vertices)).edge_count() == 12);
}

TEST_CASE("the ball lies inside also when the origin does not") {
  std::vector<Vec3> far;
  const Polyhedron box = make_box(Vec3(1, 1, 1));
  for (const Vec3& p : box.vertices()) far.push_back(p + Vec3(5, 0, 0));
  const CollisionShape shape(box.with_vertices(far));
  CHECK(shape.bounds().ball_radius == Approx(0.5));
  CHECK(shape.bounds().ball_centre.isApprox(Vec3(5, 0, 0)));
}

TEST_CASE("a shape of more corners than two bytes count is refused") {
  Random random(22);
  std::vector<Vec3> points;
  for (int i = 0; i < 12000; ++i) points.push_back(random_direction(random));
  CHECK_THROWS_WITH(CollisionShape(convex_hull(points)), Catch::Contains("65535 corners"));
}
