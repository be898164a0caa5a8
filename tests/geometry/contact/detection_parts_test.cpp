// Detection in parts, on threads: the contacts of one part alone, to the last bit.

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
    many.use_team(nullptr, 200);  // more than bodies: some parts have nothing to do
    std::vector<ContactPoint> expected, contacts;
    for (int k = 0; k < 60; ++k) {
      packing.move(step);
      if (k == 20) threads.use_team(&team, 5);  // records move to other parts
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
              a.proved_axes);  // what was remembered of pairs followed them to their new parts
        CHECK(b.full_tests == a.full_tests);
        CHECK(b.manifolds == a.manifolds);
        CHECK(b.broad_phase_rebuilds == a.broad_phase_rebuilds);
      }
    }
    CHECK(whole.counters().broad_phase_rebuilds > 1);
  }
}
