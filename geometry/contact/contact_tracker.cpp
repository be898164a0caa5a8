#include "geometry/contact/contact_tracker.hpp"

#include <limits>
#include <tuple>

namespace ballast {
namespace {

auto pair_of(const ContactPoint& c) { return std::tie(c.body_a, c.body_b); }

/// End of the run of contacts from `begin` that belong to one pair.
size_t end_of_pair(std::span<const ContactPoint> contacts, size_t begin) {
  size_t end = begin;
  while (end < contacts.size() && pair_of(contacts[end]) == pair_of(contacts[begin])) ++end;
  return end;
}

/// True if a contact of the pair, sorted by feature, has this key.
bool has_feature(std::span<const ContactPoint> pair, std::uint64_t feature) {
  for (const ContactPoint& c : pair) {
    if (c.feature == feature) return true;
  }
  return false;
}

/// Index of the nearest point whose key no old point has, or of the nearest of all if every key is
/// known.
size_t nearest(std::span<const ContactPoint> candidates, std::span<const ContactPoint> old_pair,
               const Vec3& position) {
  size_t best = 0, best_any = 0;
  double distance = std::numeric_limits<double>::infinity(), distance_any = distance;
  for (size_t i = 0; i < candidates.size(); ++i) {
    const double d = (candidates[i].position - position).squaredNorm();
    if (d < distance_any) {
      distance_any = d;
      best_any = i;
    }
    if (d < distance && !has_feature(old_pair, candidates[i].feature)) {
      distance = d;
      best = i;
    }
  }
  return distance < std::numeric_limits<double>::infinity() ? best : best_any;
}

}  // namespace

void carry_impulses(std::span<const ContactPoint> old_contacts, std::span<const Vec3> old_impulses,
                    std::span<const ContactPoint> new_contacts, std::vector<Vec3>& carried) {
  carried.assign(new_contacts.size(), Vec3::Zero());
  // Both lists are sorted by pair and feature. An impulse goes to the point with its
  // key, and that of a point that is gone to another point of its pair: what a pair
  // carries is kept while it touches.
  size_t o = 0, n = 0;
  while (o < old_contacts.size() && n < new_contacts.size()) {
    if (pair_of(old_contacts[o]) < pair_of(new_contacts[n])) {
      ++o;
      continue;
    }
    if (pair_of(new_contacts[n]) < pair_of(old_contacts[o])) {
      ++n;
      continue;
    }
    const size_t o_end = end_of_pair(old_contacts, o), n_end = end_of_pair(new_contacts, n);
    const auto old_pair = old_contacts.subspan(o, o_end - o),
               new_pair = new_contacts.subspan(n, n_end - n);
    size_t m = n;  // both are sorted by feature: one merge
    for (size_t i = o; i < o_end; ++i) {
      while (m < n_end && new_contacts[m].feature < old_contacts[i].feature) ++m;
      const bool same = m < n_end && new_contacts[m].feature == old_contacts[i].feature;
      const size_t to = same ? m : n + nearest(new_pair, old_pair, old_contacts[i].position);
      carried[to] += old_impulses[i];
    }
    o = o_end;
    n = n_end;
  }
}

}  // namespace ballast
