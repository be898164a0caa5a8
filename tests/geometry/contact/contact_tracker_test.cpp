#include "geometry/contact/contact_tracker.hpp"

#include <algorithm>
#include <map>
#include <set>
#include <tuple>

#include "geometry/shape/pose.hpp"
#include "tests/catch.hpp"

using namespace ballast;

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

/// The header's words, point by point.
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

TEST_CASE("a pair that stays keeps its sum, a pair that has gone loses it") {
  Random random(2);
  std::vector<Vec3> carried;
  for (int run = 0; run < 400; ++run) {
    const auto old_contacts = random_contacts(random, 8, 4);
    const auto new_contacts = random_contacts(random, 8, 4);
    const auto impulses = random_impulses(random, old_contacts.size());
    carry_impulses(old_contacts, impulses, new_contacts, carried);
    std::map<std::pair<int, int>, Vec3> before, after;
    for (size_t i = 0; i < new_contacts.size(); ++i) {
      const auto key = std::pair(new_contacts[i].body_a, new_contacts[i].body_b);
      before.emplace(key, Vec3::Zero());
      after.emplace(key, Vec3::Zero()).first->second += carried[i];
    }
    for (size_t i = 0; i < old_contacts.size(); ++i) {
      const auto it = before.find({old_contacts[i].body_a, old_contacts[i].body_b});
      if (it != before.end()) it->second += impulses[i];
    }
    for (const auto& [key, sum] : before) CHECK((sum - after.at(key)).norm() <= 1e-13);
  }
}

TEST_CASE("same contacts, same impulses, bit by bit; nothing to nothing") {
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

TEST_CASE("a renamed point hands over to its nearest newcomer") {
  const Vec3 n = Vec3::UnitZ();
  const std::vector<ContactPoint> old_contacts{{0, 1, 10, n, Vec3(0, 0, 0), 0.0},
                                               {0, 1, 11, n, Vec3(1, 0, 0), 0.0}};
  const std::vector<ContactPoint> new_contacts{
      {0, 1, 10, n, Vec3(1.1, 0, 0), 0.0},  // nearest, but known by name
      {0, 1, 20, n, Vec3(5, 0, 0), 0.0},
      {0, 1, 21, n, Vec3(1.2, 0, 0), 0.0}};
  std::vector<Vec3> carried;
  carry_impulses(old_contacts, std::vector<Vec3>{Vec3(1, 0, 0), Vec3(0, 2, 0)}, new_contacts,
                 carried);
  CHECK(carried[0] == Vec3(1, 0, 0));
  CHECK(carried[1] == Vec3::Zero());
  CHECK(carried[2] == Vec3(0, 2, 0));
  // all new points are known: the nearest of them takes it
  carry_impulses(old_contacts, std::vector<Vec3>{Vec3(1, 0, 0), Vec3(0, 2, 0)},
                 std::span(new_contacts).first(1), carried);
  CHECK(carried[0] == Vec3(1, 2, 0));
}
