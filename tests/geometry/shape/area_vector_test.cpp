#include "geometry/shape/area_vector.hpp"

#include <vector>

#include "geometry/shape/polyhedron.hpp"
#include "tests/catch.hpp"

using namespace ballast;

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
  // Mirrored, all faces look inwards.
  for (Vec3& p : moved) p.x() = -p.x();
  CHECK_THROWS_AS(box.with_vertices(moved), InvalidPolyhedron);
}
