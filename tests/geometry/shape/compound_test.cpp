// Bodies of parts against the solid that they fill, and walls from polygons.

#include "geometry/shape/compound.hpp"
#include "platform/random.hpp"
#include "tests/catch.hpp"

using namespace ballast;
using Catch::Matchers::Contains;

namespace {

PlacedShape box(const Vec3& size, const Vec3& place, const Quat& turn = Quat::Identity()) {
  return {std::make_shared<const Polyhedron>(make_box(size)), {place, turn}};
}

}  // namespace

TEST_CASE("a box cut into eight pieces has the whole box's mass properties") {
  const Vec3 size(0.3, 0.5, 0.7), away(4, -2, 1);
  Random random(3);
  const Quat turn = random_rotation(random);
  std::vector<PlacedShape> pieces;
  for (int k = 0; k < 8; ++k) {
    const Vec3 side(k & 1 ? 1 : -1, k & 2 ? 1 : -1, k & 4 ? 1 : -1);
    pieces.push_back(box(0.5 * size, away + turn * (0.25 * side.cwiseProduct(size)), turn));
  }
  const CompoundShape compound = make_compound(pieces);
  CHECK(compound.volume == Approx(size.prod()));
  CHECK((compound.pose.position - away).norm() < 1e-12);
  const Vec3 squares = size.cwiseAbs2();
  Vec3 moments =
      size.prod() / 12.0 *
      Vec3(squares.y() + squares.z(), squares.z() + squares.x(), squares.sum() - squares.z());
  std::sort(moments.begin(), moments.end());
  for (int k = 0; k < 3; ++k) CHECK(compound.inertia[k] == Approx(moments[k]));
  CHECK(compound.hull->circumradius() == Approx(0.5 * size.norm()));
  // The parts did not move.
  for (size_t k = 0; k < 8; ++k)
    for (const Vec3& corner : pieces[k].shape->vertices()) {
      const Vec3 ours = compound.pose * (compound.parts[k].pose * corner);
      CHECK((ours - pieces[k].pose * corner).norm() < 1e-12);
    }
}

TEST_CASE("two masses on a rod: Steiner's theorem") {
  const CompoundShape compound = make_compound(
      std::vector{box(Vec3(1, 1, 1), Vec3(3, 0, 0)), box(Vec3(1, 1, 1), Vec3(-1, 0, 0))});
  CHECK((compound.pose.position - Vec3(1, 0, 0)).norm() < 1e-14);
  CHECK(compound.inertia.x() == Approx(2.0 / 6.0));
  CHECK(compound.inertia.y() == Approx(2.0 / 6.0 + 2.0 * 4.0));
  CHECK_THROWS_WITH(make_compound({}), Contains("no parts"));
}

TEST_CASE("a thick polygon lies behind its face") {
  const std::vector<Vec3> triangle{{0, 0, 2}, {1, 0, 2}, {0, 1, 2}};
  const Polyhedron solid = thick_polygon(triangle, 0.25);
  CHECK(mass_properties(solid).volume == Approx(0.125));
  for (const Vec3& corner : solid.vertices()) CHECK((corner.z() == 2.0 || corner.z() == 1.75));
  const std::vector<Vec3> dented{{0, 0, 0}, {1, 0, 0}, {0.2, 0.2, 0}, {0, 1, 0}};
  CHECK_THROWS_WITH(thick_polygon(dented, 0.1), Contains("no flat"));
  const std::vector<Vec3> bent{{0, 0, 0}, {1, 0, 0}, {1, 1, 0.3}, {0, 1, 0}};
  CHECK_THROWS_WITH(thick_polygon(bent, 0.1), Contains("no flat"));
  CHECK_THROWS_WITH(thick_polygon(std::vector<Vec3>(3, Vec3::Ones()), 0.1),
                    Contains("without area"));
}
