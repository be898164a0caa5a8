// Points held on to: near what detection from scratch finds, and the same bits from every refresh
// on.

#include "geometry/contact/held_manifold.hpp"

#include <map>

#include "tests/catch.hpp"
#include "tests/geometry/contact/sample_packing.hpp"

using namespace ballast;
using namespace ballast::testing;

namespace {

DetectionSettings holding(double motion) {
  DetectionSettings settings;
  settings.reuse_motion = motion;
  return settings;
}

using Pair = std::pair<int, int>;

/// The smallest gap of each pair of polyhedra.
std::map<Pair, double> smallest_gaps(const std::vector<ContactPoint>& contacts,
                                     const Packing& packing) {
  std::map<Pair, double> gaps;
  for (const ContactPoint& c : contacts) {
    if (!packing.shapes[c.body_a].polyhedron) continue;
    const auto [at, is_new] = gaps.try_emplace({c.body_a, c.body_b}, c.gap);
    if (!is_new) at->second = std::min(at->second, c.gap);
  }
  return gaps;
}

}  // namespace

TEST_CASE("held points keep their features' exact gaps while the features stay") {
  const Polyhedron box = make_box(Vec3(0.2, 0.2, 0.2));
  for (const bool crossed : {false, true}) {
    const std::vector<ContactShape> shapes{{&box, {}, false}, {&box, {}, false}};
    std::vector<Pose> poses(2);
    // a corner over a face; or two edges crossing at right angles
    poses[0].rotation =
        crossed ? Quat(Eigen::AngleAxisd(0.25 * M_PI, Vec3::UnitX())) : Quat::Identity();
    poses[1].rotation =
        crossed ? Quat(Eigen::AngleAxisd(0.25 * M_PI, Vec3::UnitY()))
                : Quat(Eigen::AngleAxisd(std::atan(std::sqrt(2.0)), Vec3(1, -1, 0).normalized()));
    poses[1].position =
        Vec3(0.01, 0.02, crossed ? 0.2 * std::sqrt(2.0) : 0.1 + 0.1 * std::sqrt(3.0));
    const std::vector<double> reach(2, 1e-5);
    ContactDetector held(shapes, holding(1e-2)), fresh(shapes, {});
    std::vector<ContactPoint> contacts, expected;
    for (int k = 0; k < 20; ++k) {
      held.detect(poses, reach, contacts);
      fresh.detect(poses, reach, expected);
      CAPTURE(crossed, k);
      CHECK(held.counters().reused == (k > 0));
      REQUIRE(contacts.size() == 1);
      REQUIRE(expected.size() == 1);
      CHECK(contacts[0].feature == expected[0].feature);
      CHECK(contacts[0].gap == Approx(expected[0].gap).margin(1e-15));
      CHECK((contacts[0].normal - expected[0].normal).norm() < 1e-14);
      const double slid =
          k * 2e-5 * (Vec3(1, 0.5, -0.05).norm() + 0.2 * Vec3(0.3, -1.0, 2.0).norm());
      CHECK((contacts[0].position - expected[0].position).norm() <= (crossed ? slid : 0.0) + 1e-14);
      poses[1] = moved(poses[1], Vec3(1, 0.5, -0.05), Vec3(0.3, -1.0, 2.0),
                       2e-5);  // slides, sinks and turns
    }
    CHECK(expected[0].gap < -1e-6);
  }
}

TEST_CASE("held points lie near those from scratch, and no contact is lost by holding") {
  Packing packing(70, 0.28, 1);
  packing.relax();
  constexpr double motion = 1e-3;
  ContactDetector held(packing.shapes, holding(motion)), fresh(packing.shapes, {});
  std::vector<ContactPoint> contacts, expected;
  long reused = 0, pairs = 0, rebuilds = 0;
  for (int k = 0; k < 400; ++k) {
    packing.move(2e-6);
    held.detect(packing.poses, packing.reach, contacts);
    fresh.detect(packing.poses, packing.reach, expected);
    reused += held.counters().reused;
    rebuilds = held.counters().broad_phase_rebuilds;
    const std::map<Pair, double> got = smallest_gaps(contacts, packing),
                                 want = smallest_gaps(expected, packing);
    pairs += static_cast<long>(want.size());
    for (const auto& [pair, gap] : want) {
      CAPTURE(k, pair.first, pair.second, gap);
      const double size = packing.shapes[pair.first].polyhedron->circumradius() +
                          packing.shapes[pair.second].polyhedron->circumradius();
      const double reach = packing.reach[pair.first] + packing.reach[pair.second];
      const auto found = got.find(pair);
      if (found == got.end())
        CHECK(gap > reach - 2.0 * motion * size);  // only at the rim of the reach
      else
        CHECK(std::abs(found->second - gap) <= 2.0 * motion * size);
    }
    for (const ContactPoint& c : contacts)
      CHECK(c.gap <= packing.reach[c.body_a] + packing.reach[c.body_b]);
  }
  CHECK(reused > 0.7 * pairs);
  CHECK(rebuilds > 1);  // what is held survives a new list
}

TEST_CASE("from a refresh on, a detector and its newborn twin find the same bits, in any parts") {
  Packing packing(70, 0.28, 1);
  packing.relax();
  ContactDetector old(packing.shapes, holding(1e-3));
  std::vector<ContactPoint> contacts, expected;
  for (int round = 0; round < 6; ++round) {
    old.refresh();
    ContactDetector newborn(packing.shapes, holding(1e-3)), parts(packing.shapes, holding(1e-3));
    parts.use_team(nullptr, 7);
    long reused = 0;
    for (int k = 0; k < 25; ++k) {
      packing.move(k < 5 ? 1e-6 : 1e-5);
      if (k == 12) packing.poses[10 + round].position += 0.02 * random_direction(packing.random);
      old.detect(packing.poses, packing.reach, expected);
      reused += old.counters().reused;
      for (ContactDetector* twin : {&newborn, &parts}) {
        twin->detect(packing.poses, packing.reach, contacts);
        CAPTURE(round, k, twin == &parts);
        REQUIRE(contacts.size() == expected.size());
        REQUIRE(same_bits(contacts, expected));
        CHECK(twin->counters().reused == old.counters().reused);
      }
    }
    CHECK(reused > 0);
  }
}

TEST_CASE("without a cache nothing is held") {
  Packing packing(30, 0.2, 1);
  DetectionSettings settings = holding(1e-2);
  settings.use_cache = false;
  ContactDetector held(packing.shapes, settings), fresh(packing.shapes, {});
  std::vector<ContactPoint> contacts, expected;
  for (int k = 0; k < 3; ++k) {
    held.detect(packing.poses, packing.reach, contacts);
    fresh.detect(packing.poses, packing.reach, expected);
    CHECK(held.counters().reused == 0);
    CHECK(contacts.size() == expected.size());
    CHECK(same_bits(contacts, expected));
  }
}
