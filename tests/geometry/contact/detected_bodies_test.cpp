#include "geometry/contact/detected_bodies.hpp"

#include "tests/catch.hpp"
#include "tests/geometry/contact/sample_packing.hpp"

using namespace ballast;
using namespace ballast::testing;

namespace {

ContactShape body(const Polyhedron& polyhedron) { return {&polyhedron, {}, false}; }

}  // namespace

TEST_CASE("bodies of one polyhedron share its tables; planes have none") {
  const Polyhedron small = make_box(Vec3(1, 1, 1)), large = make_box(Vec3(2, 2, 2));
  const DetectedBodies bodies({body(large), ContactShape{}, body(small), body(large)}, 0.1);
  REQUIRE(bodies.tables.size() == 2);
  CHECK(bodies.shape(0) == bodies.shape(3));
  CHECK(bodies.shape(0) != bodies.shape(2));
  CHECK(bodies.shape(1) == nullptr);
  CHECK(bodies.bounds[0].circumradius == large.circumradius());
  CHECK(bodies.bounds[1].circumradius == 0.0);
  CHECK(bodies.bounds[2].circumradius == small.circumradius());
  CHECK(bodies.margin[2] == Approx(0.1 * small.circumradius()));
  CHECK(bodies.holds());
  CHECK_FALSE(DetectedBodies({body(small)}, 0.0).holds());
}

TEST_CASE("reaches grow by the margins only where points are held on to") {
  const Polyhedron box = make_box(Vec3(1, 1, 1));
  const std::vector<Pose> poses(1);
  const std::vector<double> reach = {0.5};
  DetectedBodies plain({body(box)}, 0.0), holding({body(box)}, 0.1);
  for (DetectedBodies* bodies : {&plain, &holding}) {
    bodies->take(poses, reach);
    CHECK(bodies->given_reach[0] == 0.5);
  }
  CHECK(plain.reach[0] == 0.5);
  CHECK(holding.reach[0] == Approx(0.5 + 0.1 * box.circumradius()));
}

TEST_CASE("the travel bounds how far any point of a body has moved since the first call") {
  Packing packing(20, 0.3, 9);
  DetectedBodies bodies(packing.shapes, 0.0);
  const std::vector<Pose> start = packing.poses;
  bodies.take(start, packing.reach);
  for (const Travel& travel : bodies.travel) CHECK((travel.shift == 0.0 && travel.turn == 0.0));
  std::vector<std::vector<Pose>> path;  // outlives the calls
  for (int k = 0; k < 30; ++k) {
    packing.move(1e-3);
    path.push_back(packing.poses);
    bodies.take(path.back(), packing.reach);
  }
  int moved_bodies = 0;
  for (int i = 0; i < bodies.count(); ++i) {
    CHECK(bodies.rotations[i] == packing.poses[i].rotation.toRotationMatrix());
    if (!bodies.shape(i)) continue;
    const Travel& travel = bodies.travel[i];
    double farthest = 0.0;
    for (const Vec3& vertex : bodies.shapes[i].polyhedron->vertices())
      farthest = std::max(farthest, (packing.poses[i] * vertex - start[i] * vertex).norm());
    CHECK(farthest <= travel.shift + bodies.bounds[i].circumradius * travel.turn + 1e-14);
    moved_bodies += farthest > 1e-3;
    if (packing.shapes[i].fixed) CHECK(travel.shift == 0.0);
  }
  CHECK(moved_bodies > 10);
}
