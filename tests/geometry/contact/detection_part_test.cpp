#include "geometry/contact/detection_part.hpp"

#include "platform/worker_team.hpp"
#include "tests/catch.hpp"
#include "tests/geometry/contact/sample_packing.hpp"

using namespace ballast;
using namespace ballast::testing;

TEST_CASE("detection in parts finds the same contacts, bit by bit, and counts the same pairs") {
  for (const double step : {1e-5, 1e-3}) {
    Packing packing(70, step < 5e-4 ? 0.28 : 0.25, 1);
    if (step < 5e-4) packing.relax();
    ContactDetector whole(packing.shapes, {}), threads(packing.shapes, {}),
        many(packing.shapes, {});
    WorkerTeam team;
    team.resize(3);
    threads.use_team(&team, 3);
    many.use_team(nullptr, 200);  // more parts than bodies: some are empty
    std::vector<ContactPoint> expected, contacts;
    for (int k = 0; k < 60; ++k) {
      packing.move(step);
      if (k == 20) threads.use_team(&team, 5);  // pairs move to other parts
      whole.detect(packing.poses, packing.reach, expected);
      for (ContactDetector* detector : {&threads, &many}) {
        detector->detect(packing.poses, packing.reach, contacts);
        const DetectionCounters &a = whole.counters(), &b = detector->counters();
        CAPTURE(step, k, detector == &many);
        REQUIRE(same_bits(contacts, expected));
        REQUIRE(contacts.size() == expected.size());
        CHECK(b.candidate_pairs == a.candidate_pairs);
        CHECK(b.cached_separations == a.cached_separations);
        CHECK(b.proved_axes ==
              a.proved_axes);  // the memory of pairs moved with them to their new parts
        CHECK(b.full_tests == a.full_tests);
        CHECK(b.manifolds == a.manifolds);
        CHECK(b.broad_phase_rebuilds == a.broad_phase_rebuilds);
      }
    }
    CHECK(whole.counters().broad_phase_rebuilds > 1);
  }
}

TEST_CASE("bodies of one polyhedron share its tables, planes have none") {
  const Polyhedron small = make_box(Vec3(1, 1, 1)), large = make_box(Vec3(2, 2, 2));
  const DetectedBodies bodies(
      {{&large, {}, false}, ContactShape{}, {&small, {}, false}, {&large, {}, false}});
  REQUIRE(bodies.tables.size() == 2);
  CHECK(bodies.shape(0) == bodies.shape(3));
  CHECK(bodies.shape(0) != bodies.shape(2));
  CHECK(bodies.shape(1) == nullptr);
  CHECK(bodies.bounds[0].circumradius == large.circumradius());
  CHECK(bodies.bounds[1].circumradius == 0.0);
  CHECK(bodies.bounds[2].circumradius == small.circumradius());
}

TEST_CASE("the travel bounds how far any point of a body has moved since the first call") {
  Packing packing(20, 0.3, 9);
  DetectedBodies bodies(packing.shapes);
  const std::vector<Pose> start = packing.poses;
  bodies.take(start, packing.reach);
  for (const MotionBound& travel : bodies.travel)
    CHECK((travel.shift == 0.0 && travel.turn == 0.0));
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
    const MotionBound& travel = bodies.travel[i];
    double farthest = 0.0;
    for (const Vec3& vertex : bodies.shapes[i].polyhedron->vertices())
      farthest = std::max(farthest, (packing.poses[i] * vertex - start[i] * vertex).norm());
    CHECK(farthest <= travel.shift + bodies.bounds[i].circumradius * travel.turn + 1e-14);
    moved_bodies += farthest > 1e-3;
    if (packing.shapes[i].fixed) CHECK(travel.shift == 0.0);
  }
  CHECK(moved_bodies > 10);
}
