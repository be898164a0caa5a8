#include "geometry/shape/face_loops.hpp"

#include <algorithm>

#include "geometry/shape/mass_properties.hpp"
#include "platform/random.hpp"
#include "tests/catch.hpp"
#include "tests/geometry/shape/loops_of.hpp"

using namespace ballast;

TEST_CASE("loops in any order, begun anywhere and turned round are put in one order") {
  const Polyhedron box = make_box(Vec3(1, 2, 3));
  Loops expected = loops_of(box);
  make_canonical(expected, box.vertices());
  CHECK(std::ranges::is_sorted(expected));
  Random random(8);
  for (int trial = 0; trial < 20; ++trial) {
    Loops loops = loops_of(box);
    for (auto& loop : loops) {
      std::rotate(loop.begin(), loop.begin() + static_cast<long>(random.below(4)), loop.end());
      if (random.below(2) == 0) std::reverse(loop.begin(), loop.end());
    }
    for (size_t f = loops.size(); f > 1; --f) std::swap(loops[f - 1], loops[random.below(f)]);
    make_canonical(loops, box.vertices());
    CHECK(loops == expected);
  }
  for (const auto& loop : expected) CHECK(loop[0] == *std::ranges::min_element(loop));
}

TEST_CASE("the solid of loops has only their points, in the points' order") {
  const Polyhedron box = make_box(Vec3(1, 2, 3));
  std::vector<Vec3> points{Vec3::Zero()};
  Loops loops = loops_of(box);
  for (const Vec3& p : box.vertices()) points.insert(points.end(), {p, 0.5 * p});
  for (auto& loop : loops)
    for (int& v : loop) v = 1 + 2 * v;
  const Polyhedron solid = solid_of(points, loops);
  REQUIRE(solid.vertex_count() == 8);
  CHECK(std::ranges::equal(solid.vertices(), box.vertices()));
  CHECK(mass_properties(solid).volume == Approx(6.0));
  loops.pop_back();
  CHECK_THROWS_AS(solid_of(points, loops), InvalidPolyhedron);
}
