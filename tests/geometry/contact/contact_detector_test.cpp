#include "geometry/contact/contact_detector.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <stdexcept>
#include <tuple>

#include "tests/catch.hpp"
#include "tests/geometry/contact/allocation_counter.hpp"
#include "tests/geometry/contact/detection_support.hpp"
#include "tests/geometry/contact/sample_packing.hpp"

using namespace ballast;
using namespace ballast::testing;

namespace {

/// Checks that contacts are sorted, unique, within reach, and have unit normals from a to b.
void check_list(const std::vector<ContactPoint>& contacts, const Packing& packing) {
  bool fits = true;
  for (size_t i = 0; i < contacts.size(); ++i) {
    const ContactPoint &c = contacts[i], &before = contacts[i > 0 ? i - 1 : 0];
    fits &= i == 0 || std::tie(before.body_a, before.body_b, before.feature) <
                          std::tie(c.body_a, c.body_b, c.feature);
    fits &= std::abs(c.normal.norm() - 1.0) <= 1e-14;
    fits &= c.body_a < c.body_b || !packing.shapes[c.body_a].polyhedron;
    fits &= packing.shapes[c.body_b].polyhedron != nullptr;
    fits &= c.gap <= packing.reach[c.body_a] + packing.reach[c.body_b];
  }
  CHECK(fits);
}

}  // namespace

TEST_CASE("contacts depend on poses and reaches only: with and without cache, bit by bit") {
  for (double step : {1e-6, 1e-5, 1e-4, 1e-3}) {
    Packing packing(70, step < 5e-4 ? 0.28 : 0.25, 1);
    if (step < 5e-4)
      packing.relax();  // without it, deep overlaps, many equally deep along several axes
    DetectionSettings fresh;
    fresh.use_cache = false;
    ContactDetector cached(packing.shapes, {}), from_scratch(packing.shapes, fresh);
    std::vector<ContactPoint> contacts, expected;
    long proved = 0, searched = 0;
    for (int k = 0; k < 120; ++k) {
      packing.move(step);
      const int some = packing.random.below(static_cast<int>(packing.shapes.size()));
      if (k % 20 == 7) packing.poses[some].position += 0.05 * random_direction(packing.random);
      if (k % 20 == 13) packing.reach[some] = 1e-3 * packing.random.uniform();
      cached.detect(packing.poses, packing.reach, contacts);
      from_scratch.detect(packing.poses, packing.reach, expected);
      proved += cached.counters().proved_axes;
      searched += cached.counters().full_tests;
      if (!same_bits(contacts, expected)) FAIL_CHECK("step " << k << " of size " << step);
      if (k % 30 == 0) {  // compares with a new detector without any memory
        ContactDetector newborn(packing.shapes, {});
        newborn.detect(packing.poses, packing.reach, contacts);
        if (!same_bits(contacts, expected))
          FAIL_CHECK("newborn at step " << k << " of size " << step);
      }
      CHECK(contacts.size() > 50);
      check_list(contacts, packing);
    }
    if (step < 5e-5) CHECK(proved > 5 * searched);  // the cache saves most searches
  }
}

TEST_CASE("pairs that part, rest apart and roll: with and without cache, bit by bit") {
  constexpr double reach = 1e-3;
  DetectionSettings fresh;
  fresh.use_cache = false;
  for (std::uint64_t seed = 1; seed <= 4; ++seed) {
    Packing packing(60, 0.25, seed);
    packing.relax();
    for (double& r : packing.reach) r = reach * packing.random.uniform();
    ContactDetector cached(packing.shapes, {}), from_scratch(packing.shapes, fresh);
    std::vector<ContactPoint> contacts, expected;
    for (int k = 0; k < 60; ++k) {
      const int phase = k % 6;
      for (size_t i = 0; i < packing.shapes.size(); ++i) {
        if (!packing.shapes[i].polyhedron || packing.shapes[i].fixed) continue;
        Pose& pose = packing.poses[i];
        Vec3& way = packing.velocity[i];
        if (phase == 0) pose.position -= 2.0 * reach * way;  // together
        if (phase == 1) way = random_direction(packing.random);
        if (phase == 1 || phase == 2) pose.position += reach * way;  // apart
        if (phase >= 4) pose = moved(pose, Vec3::Zero(), way, 0.02);
      }
      cached.detect(packing.poses, packing.reach, contacts);
      from_scratch.detect(packing.poses, packing.reach, expected);
      if (!same_bits(contacts, expected)) FAIL_CHECK("seed " << seed << ", step " << k);
    }
  }
}

TEST_CASE("all pairs by brute force: who touches, and how deep") {
  Packing packing(40, 0.25, 2);
  DetectionSettings settings;
  settings.max_points = 100;
  ContactDetector detector(packing.shapes, settings);
  std::vector<ContactPoint> contacts;
  int touching = 0, apart = 0, beside = 0;
  for (int k = 0; k < 12; ++k) {
    packing.move(0.005);
    for (double& reach : packing.reach)
      reach = k % 3 == 0 ? 0.0 : std::pow(10.0, -packing.random.uniform(2.5, 7.0));
    detector.detect(packing.poses, packing.reach, contacts);
    std::map<std::pair<int, int>, double> least;
    for (const ContactPoint& c : contacts) {
      const auto it = least.emplace(std::pair(c.body_a, c.body_b), c.gap).first;
      it->second = std::min(it->second, c.gap);
    }
    const int count = static_cast<int>(packing.shapes.size());
    for (int a = 0; a < count; ++a) {
      for (int b = a + 1; b < count; ++b) {
        const ContactShape &shape_a = packing.shapes[a], &shape_b = packing.shapes[b];
        if (!shape_a.polyhedron || !shape_b.polyhedron) continue;
        const auto found = least.find({a, b});
        if (shape_a.fixed && shape_b.fixed) {
          CHECK(found == least.end());
          continue;
        }
        const Mat3 to_a = packing.poses[a].rotation.toRotationMatrix().transpose();
        const RelativePose b_in_a{to_a * packing.poses[b].rotation.toRotationMatrix(),
                                  to_a * (packing.poses[b].position - packing.poses[a].position)};
        const BruteForce oracle = brute_force(*shape_a.polyhedron, *shape_b.polyhedron, b_in_a);
        const double alert = packing.reach[a] + packing.reach[b], tolerance = 1e-12;
        if (oracle.facets > alert + tolerance || oracle.all > alert + tolerance) {
          // The gap along some axis exceeds the reach; for bodies side by side facets give less.
          if (oracle.facets > alert + tolerance) CHECK(found == least.end());
          beside += oracle.facets <= alert + tolerance;
          ++apart;
        } else if (oracle.facets < alert - tolerance) {
          REQUIRE(found != least.end());
          CHECK(std::abs(found->second - oracle.facets) <= tolerance);
          ++touching;
        }
      }
    }
  }
  CHECK(touching > 300);
  CHECK(apart > 5000);
  CHECK(beside < touching / 10);
}

TEST_CASE("planes: every vertex within reach, by definition") {
  Packing packing(50, 0.2, 3);
  ContactDetector detector(packing.shapes, {});
  std::vector<ContactPoint> contacts;
  packing.poses[0].rotation = random_rotation(packing.random);  // a wall need not be upright
  detector.detect(packing.poses, packing.reach, contacts);
  const int count = static_cast<int>(packing.shapes.size());
  size_t expected = 0;
  for (int a = 0; a < count; ++a) {
    if (packing.shapes[a].polyhedron) continue;
    const Vec3 normal = packing.poses[a].rotation * packing.shapes[a].plane.normal;
    for (int b = 0; b < count; ++b) {
      const Polyhedron* body = packing.shapes[b].polyhedron;
      if (!body || (packing.shapes[a].fixed && packing.shapes[b].fixed)) continue;
      for (int v = 0; v < body->vertex_count(); ++v) {
        const Vec3 p = packing.poses[b] * body->vertex(v);
        const double gap = normal.dot(p - packing.poses[a].position);
        if (gap > packing.reach[a] + packing.reach[b]) continue;
        ++expected;
        const auto found =
            std::find_if(contacts.begin(), contacts.end(), [&](const ContactPoint& c) {
              return c.body_a == a && c.body_b == b && c.feature == static_cast<std::uint64_t>(v);
            });
        REQUIRE(found != contacts.end());
        CHECK(found->gap == Approx(gap).margin(1e-15));
        CHECK((found->normal - normal).norm() <= 1e-15);
        CHECK((found->position - (p - 0.5 * gap * normal)).norm() <= 1e-15);
      }
    }
  }
  const auto with_plane =
      std::count_if(contacts.begin(), contacts.end(),
                    [&](const ContactPoint& c) { return !packing.shapes[c.body_a].polyhedron; });
  CHECK(static_cast<size_t>(with_plane) == expected);
  CHECK(expected > 50);
}

TEST_CASE("the whole scene moved rigidly has its contacts moved with it") {
  Packing packing(60, 0.25, 5);
  ContactDetector detector(packing.shapes, {}), other(packing.shapes, {});
  std::vector<ContactPoint> contacts, turned;
  for (int k = 0; k < 10; ++k) {
    packing.move(0.01);
    Pose frame;
    frame.position = random_direction(packing.random);
    frame.rotation = random_rotation(packing.random);
    std::vector<Pose> poses;
    for (const Pose& pose : packing.poses) {
      Pose next;
      next.position = frame * pose.position;
      next.rotation = (frame.rotation * pose.rotation).normalized();
      poses.push_back(next);
    }
    detector.detect(packing.poses, packing.reach, contacts);
    check_list(contacts, packing);
    other.detect(poses, packing.reach, turned);
    REQUIRE(contacts.size() == turned.size());
    for (size_t i = 0; i < contacts.size(); ++i) {
      CHECK(contacts[i].feature == turned[i].feature);
      CHECK(contacts[i].body_b == turned[i].body_b);
      CHECK(std::abs(contacts[i].gap - turned[i].gap) <= 1e-14);
      CHECK((frame.rotation * contacts[i].normal - turned[i].normal).norm() <= 1e-12);
      CHECK((frame * contacts[i].position - turned[i].position).norm() <= 1e-11);
    }
  }
}

TEST_CASE("no allocation once grown, and counters that add up") {
  Packing packing(70, 0.25, 6);
  ContactDetector detector(packing.shapes, {});
  std::vector<ContactPoint> contacts;
  std::vector<std::vector<Pose>> trajectory;
  for (int k = 0; k < 60; ++k) {
    packing.move(1e-3);
    trajectory.push_back(packing.poses);
  }
  for (const auto& poses : trajectory) detector.detect(poses, packing.reach, contacts);
  const long rebuilds = detector.counters().broad_phase_rebuilds;
  CHECK(rebuilds > 5);
  bool counters_fit = true;
  const long before = allocation_count();
  for (const auto& poses : trajectory) {
    detector.detect(poses, packing.reach, contacts);
    const DetectionCounters& c = detector.counters();
    counters_fit &= c.cached_separations + c.proved_axes + c.full_tests <= c.candidate_pairs;
  }
  const long during = allocation_count() - before;
  CHECK(during == 0);
  CHECK(counters_fit);
  CHECK(detector.counters().broad_phase_rebuilds > rebuilds);
  std::map<std::pair<int, int>, int> pairs;
  for (const ContactPoint& c : contacts) ++pairs[{c.body_a, c.body_b}];
  CHECK(detector.counters().manifolds == static_cast<long>(pairs.size()));
}

TEST_CASE("what is not a number, or not as many, is refused by name") {
  Packing packing(5, 0.2, 7);
  ContactDetector detector(packing.shapes, {});
  std::vector<ContactPoint> contacts;
  auto poses = packing.poses;
  poses[4].position.y() = NAN;
  CHECK_THROWS_WITH(detector.detect(poses, packing.reach, contacts), Catch::Contains("body 4"));
  poses = packing.poses;
  poses[2].rotation.w() = INFINITY;
  CHECK_THROWS_WITH(detector.detect(poses, packing.reach, contacts), Catch::Contains("body 2"));
  auto reach = packing.reach;
  for (const double bad : {std::nan(""), -1.0}) {
    reach[1] = bad;
    CHECK_THROWS_AS(detector.detect(packing.poses, reach, contacts), std::invalid_argument);
  }
  reach = packing.reach;
  reach.pop_back();
  CHECK_THROWS_AS(detector.detect(packing.poses, reach, contacts), std::invalid_argument);
  detector.detect(packing.poses, packing.reach, contacts);  // works again

  ContactDetector nothing({}, {});
  nothing.detect({}, {}, contacts);
  CHECK(contacts.empty());
}

TEST_CASE("a box on a plane stands on four corners") {
  const Polyhedron box = make_box(Vec3(0.2, 0.1, 0.05));
  std::vector<ContactShape> shapes{{&box, {}, false}, {nullptr, {Vec3::UnitZ()}, true}};
  std::vector<Pose> poses(2);
  poses[0].position = Vec3(1, 2, 0.025 - 1e-6);
  ContactDetector detector(shapes, {});
  std::vector<ContactPoint> contacts;
  detector.detect(poses, std::vector<double>{1e-6, 0.0}, contacts);
  REQUIRE(contacts.size() == 4);
  Vec3 sum = Vec3::Zero();
  for (const ContactPoint& c : contacts) {
    CHECK(c.body_a == 1);  // a plane is always body a
    CHECK(c.body_b == 0);
    CHECK(c.gap == Approx(-1e-6).epsilon(1e-8));
    CHECK(c.normal == Vec3::UnitZ());
    sum += c.position / 4.0;
  }
  CHECK((sum - Vec3(1, 2, -0.5e-6)).norm() <= 1e-14);
  poses[0].position.z() = 0.025 + 1.1e-6;
  detector.detect(poses, std::vector<double>{1e-6, 0.0}, contacts);
  CHECK(contacts.empty());
}

namespace {

std::vector<ContactPoint> random_contacts(Random& random, int pairs, int features) {
  std::vector<ContactPoint> contacts;
  std::set<std::tuple<int, int, std::uint64_t>> used;
  for (int i = 0; i < 3 * pairs; ++i) {
    const int a = random.below(pairs), b = a + 1 + random.below(2);
    const std::uint64_t feature = static_cast<std::uint64_t>(random.below(features))
                                  << (random.below(2) ? 0 : 40);
    if (!used.emplace(a, b, feature).second) continue;
    contacts.push_back({a, b, feature, random_direction(random), random_direction(random), 0.0});
  }
  std::sort(contacts.begin(), contacts.end(), [](const ContactPoint& p, const ContactPoint& q) {
    return std::tie(p.body_a, p.body_b, p.feature) < std::tie(q.body_a, q.body_b, q.feature);
  });
  return contacts;
}

bool same_pair(const ContactPoint& p, const ContactPoint& q) {
  return p.body_a == q.body_a && p.body_b == q.body_b;
}

/// The rule in the header's words, point by point.
std::vector<Vec3> carried_by_definition(const std::vector<ContactPoint>& old_contacts,
                                        const std::vector<Vec3>& impulses,
                                        const std::vector<ContactPoint>& new_contacts) {
  std::vector<Vec3> carried(new_contacts.size(), Vec3::Zero());
  const auto matched = [](const ContactPoint& p, const std::vector<ContactPoint>& list) {
    return std::any_of(list.begin(), list.end(), [&](const ContactPoint& q) {
      return same_pair(p, q) && p.feature == q.feature;
    });
  };
  for (size_t i = 0; i < old_contacts.size(); ++i) {
    int target = -1;
    bool target_free = false;
    for (size_t j = 0; j < new_contacts.size(); ++j) {
      if (!same_pair(old_contacts[i], new_contacts[j])) continue;
      if (old_contacts[i].feature == new_contacts[j].feature) {
        target = static_cast<int>(j);
        break;
      }
      const bool is_free = !matched(new_contacts[j], old_contacts);
      const auto distance = [&](int k) {
        return (new_contacts[k].position - old_contacts[i].position).norm();
      };
      if (target < 0 || (is_free && !target_free) ||
          (is_free == target_free && distance(static_cast<int>(j)) < distance(target))) {
        target = static_cast<int>(j);
        target_free = is_free;
      }
    }
    if (target >= 0) carried[target] += impulses[i];
  }
  return carried;
}

std::vector<Vec3> random_impulses(Random& random, size_t count) {
  std::vector<Vec3> impulses;
  for (size_t i = 0; i < count; ++i) impulses.push_back(random_direction(random));
  return impulses;
}

}  // namespace

TEST_CASE("impulses are carried as the definition says") {
  Random random(1);
  std::vector<Vec3> carried;
  int moved = 0;
  for (int run = 0; run < 400; ++run) {
    const auto old_contacts = random_contacts(random, 1 + random.below(12), 2 + random.below(6));
    const auto new_contacts = random_contacts(random, 1 + random.below(12), 2 + random.below(6));
    const auto impulses = random_impulses(random, old_contacts.size());
    carry_impulses(old_contacts, impulses, new_contacts, carried);
    const auto expected = carried_by_definition(old_contacts, impulses, new_contacts);
    REQUIRE(carried.size() == expected.size());
    for (size_t i = 0; i < carried.size(); ++i) {
      CHECK((carried[i] - expected[i]).norm() <= 1e-14);
      moved += carried[i] != Vec3::Zero();
    }
  }
  CHECK(moved > 1000);
}

TEST_CASE("same contacts, same impulses, bit by bit, nothing to nothing") {
  Random random(3);
  const auto contacts = random_contacts(random, 50, 9);
  const auto impulses = random_impulses(random, contacts.size());
  std::vector<Vec3> carried(7, Vec3::Constant(NAN));
  carry_impulses(contacts, impulses, contacts, carried);
  REQUIRE(carried.size() == contacts.size());
  for (size_t i = 0; i < carried.size(); ++i) CHECK(carried[i] == impulses[i]);
  carry_impulses({}, {}, contacts, carried);
  for (const Vec3& r : carried) CHECK(r == Vec3::Zero());
  carry_impulses(contacts, impulses, {}, carried);
  CHECK(carried.empty());
}

TEST_CASE("a team carries as the caller alone does, pairs across its ranges too") {
  Random random(5);
  WorkerTeam team;
  team.resize(3);
  for (const int features : {2, 9}) {
    const auto old_contacts = random_contacts(random, 1500, features);
    const auto new_contacts = random_contacts(random, 1400, features);
    const auto impulses = random_impulses(random, old_contacts.size());
    std::vector<Vec3> alone, shared;
    carry_impulses(old_contacts, impulses, new_contacts, alone);
    carry_impulses(old_contacts, impulses, new_contacts, shared, &team);
    CHECK(shared == alone);
    const auto expected = carried_by_definition(old_contacts, impulses, new_contacts);
    double off = 0.0;
    for (size_t i = 0; i < expected.size(); ++i)
      off = std::max(off, (alone[i] - expected[i]).norm());
    CHECK(off <= 1e-12);
  }
}

TEST_CASE("a renamed point hands over to its nearest newcomer") {
  const Vec3 n = Vec3::UnitZ();
  const std::vector<ContactPoint> old_contacts{{0, 1, 10, n, Vec3(0, 0, 0), 0.0},
                                               {0, 1, 11, n, Vec3(1, 0, 0), 0.0}};
  const std::vector<ContactPoint> new_contacts{
      {0, 1, 10, n, Vec3(1.1, 0, 0), 0.0},  // nearest, but matched by its feature
      {0, 1, 20, n, Vec3(5, 0, 0), 0.0},
      {0, 1, 21, n, Vec3(1.2, 0, 0), 0.0}};
  std::vector<Vec3> carried;
  carry_impulses(old_contacts, std::vector<Vec3>{Vec3(1, 0, 0), Vec3(0, 2, 0)}, new_contacts,
                 carried);
  CHECK(carried[0] == Vec3(1, 0, 0));
  CHECK(carried[1] == Vec3::Zero());
  CHECK(carried[2] == Vec3(0, 2, 0));
  // All new points are matched: the nearest of them takes the impulse.
  carry_impulses(old_contacts, std::vector<Vec3>{Vec3(1, 0, 0), Vec3(0, 2, 0)},
                 std::span(new_contacts).first(1), carried);
  CHECK(carried[0] == Vec3(1, 2, 0));
}
