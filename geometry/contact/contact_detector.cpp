#include "geometry/contact/contact_detector.hpp"

#include <algorithm>
#include <limits>
#include <stdexcept>
#include <string>
#include <tuple>

namespace ballast {
namespace {

/// The scene's skin or, where the scene leaves it open, 5 % of the mean circumradius [m].
double chosen_skin(double skin, std::span<const CollisionShape> shapes) {
  if (skin > 0.0 || shapes.empty()) return skin;
  double sum = 0.0;
  for (const CollisionShape& shape : shapes) sum += shape.circumradius();
  return 0.05 * sum / static_cast<double>(shapes.size());
}

}  // namespace

ContactDetector::ContactDetector(std::vector<ContactShape> shapes,
                                 const DetectionSettings& settings, const Period& period)
    : settings_(settings),
      body_count_(shapes.size()),
      elements_(ConvexElements::are_needed(shapes, period)
                    ? std::make_optional<ConvexElements>(shapes, period)
                    : std::nullopt),
      bodies_(elements_ ? elements_->shapes() : std::move(shapes),
              elements_ ? &*elements_ : nullptr),
      broad_phase_(bodies_.listed, chosen_skin(settings.skin, bodies_.tables)) {
  use_team(nullptr, 1);
}

void ContactDetector::use_team(WorkerTeam* team, int parts) {
  team_ = team;
  broad_phase_.use_team(team);
  while (static_cast<int>(parts_.size()) < parts) parts_.emplace_back(bodies_, settings_);
  share();
}

void ContactDetector::detect(std::span<const Pose> poses, std::span<const double> reach,
                             std::vector<ContactPoint>& contacts, std::span<const Pose> ahead) {
  check(poses, reach);
  if (elements_) {
    elements_->place(poses, reach, ahead);
    ahead = elements_->ahead();
    poses = elements_->poses();
    reach = elements_->reach();
  }
  // Computes all rotations once, then the candidate pairs, then the contacts of each part's pairs.
  bodies_.take(poses, reach, ahead, team_);
  const long rebuilds = broad_phase_.rebuilds();
  broad_phase_.update(poses, bodies_.rotations, bodies_.reach);
  if (broad_phase_.rebuilds() != rebuilds) share();
  // A single part writes to `contacts`; the contacts of several are put together in their order.
  const int parts = static_cast<int>(parts_.size());
  run_parts(team_, parts, [&](int k) {
    std::vector<ContactPoint>& found = parts == 1 ? contacts : parts_[k].found;
    found.clear();
    parts_[k].detect(broad_phase_, found);
  });
  if (parts > 1) put_together(contacts);
  counters_ = DetectionCounters{};
  counters_.broad_phase_rebuilds = broad_phase_.rebuilds();
  for (const DetectionPart& part : parts_)
    for (const auto counter :
         {&DetectionCounters::candidate_pairs, &DetectionCounters::cached_separations,
          &DetectionCounters::proved_axes, &DetectionCounters::full_tests,
          &DetectionCounters::manifolds})
      counters_.*counter += part.counters().*counter;
  if (elements_) elements_->name_bodies(contacts);
}

/// Concatenates the parts' contacts; normally each thread copies those that it has found.
void ContactDetector::put_together(std::vector<ContactPoint>& contacts) {
  size_t count = 0;
  for (DetectionPart& part : parts_)
    part.first_found = std::exchange(count, count + part.found.size());
  if (count > contacts.capacity()) contacts.reserve(count + count / 8);  // room for later steps
  contacts.resize(count);
  run_parts(team_, static_cast<int>(parts_.size()), [&](int k) {
    std::ranges::copy(parts_[k].found, contacts.begin() + static_cast<long>(parts_[k].first_found));
  });
}

void ContactDetector::check(std::span<const Pose> poses, std::span<const double> reach) const {
  if (poses.size() != body_count_ || reach.size() != body_count_)
    throw std::invalid_argument("detect: " + std::to_string(body_count_) + " bodies, but " +
                                std::to_string(poses.size()) + " poses and " +
                                std::to_string(reach.size()) + " reaches");
  for (size_t i = 0; i < poses.size(); ++i)
    if (!poses[i].position.allFinite() || !poses[i].rotation.coeffs().allFinite() ||
        !(reach[i] >= 0.0))
      throw std::invalid_argument("detect: pose or reach of body " + std::to_string(i) +
                                  " is not a finite number");
}

/// Deals the bodies out to the parts, so that each has about the same work.
void ContactDetector::share() {
  // A plane tests all bodies, which is as much work as one pair for every 64 of them.
  const size_t plane_work = 1 + bodies_.shapes.size() / 64;
  const auto work_of = [&](int a) {
    return (bodies_.shape(a) ? 0 : plane_work) +
           static_cast<size_t>(broad_phase_.first(a + 1) - broad_phase_.first(a));
  };
  size_t total = 0, passed = 0;
  for (int a = 0; a < bodies_.count(); ++a) total += work_of(a);
  // Each part is a run of neighbours in the list, so that the parts' contacts, one after the other,
  // are in the order that one part alone would give.
  int begin = 0;
  for (size_t k = 0; k < parts_.size(); ++k) {
    int end = begin;
    while (end < bodies_.count() &&
           (k + 1 == parts_.size() || passed * parts_.size() < (k + 1) * total))
      passed += work_of(end++);
    parts_[k].take_range(begin, end);
    begin = end;
  }
}

// ---- warm starts

namespace {

auto pair_of(const ContactPoint& c) { return std::tie(c.body_a, c.body_b); }

/// End of the run of contacts from `begin` that belong to one pair.
size_t end_of_pair(std::span<const ContactPoint> contacts, size_t begin) {
  size_t end = begin;
  while (end < contacts.size() && pair_of(contacts[end]) == pair_of(contacts[begin])) ++end;
  return end;
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
    if (d < distance && std::ranges::find(old_pair, candidates[i].feature,
                                          &ContactPoint::feature) == old_pair.end()) {
      distance = d;
      best = i;
    }
  }
  return distance < std::numeric_limits<double>::infinity() ? best : best_any;
}

/// Adds the impulses of a pair's old points to those of its new ones.
void carry_pair(std::span<const ContactPoint> old_pair, std::span<const Vec3> impulses,
                std::span<const ContactPoint> new_pair, Vec3* carried) {
  size_t m = 0;  // both are sorted by feature: one merge
  for (size_t i = 0; i < old_pair.size(); ++i) {
    while (m < new_pair.size() && new_pair[m].feature < old_pair[i].feature) ++m;
    const bool same = m < new_pair.size() && new_pair[m].feature == old_pair[i].feature;
    carried[same ? m : nearest(new_pair, old_pair, old_pair[i].position)] += impulses[i];
  }
}

/// Carries the impulses to the pairs of new points that begin in [begin, end).
void carry_range(std::span<const ContactPoint> old_contacts, std::span<const Vec3> impulses,
                 std::span<const ContactPoint> new_contacts, size_t begin, size_t end,
                 std::vector<Vec3>& carried) {
  size_t n = begin;
  while (n > 0 && n < end && pair_of(new_contacts[n - 1]) == pair_of(new_contacts[n])) ++n;
  if (n == end) return;
  auto old = std::ranges::lower_bound(old_contacts, pair_of(new_contacts[n]), {}, pair_of);
  for (size_t n_end = n; n < end; n = n_end) {
    n_end = end_of_pair(new_contacts, n);
    std::fill(carried.begin() + n, carried.begin() + n_end, Vec3::Zero());
    const auto pair = pair_of(new_contacts[n]);
    while (old != old_contacts.end() && pair_of(*old) < pair) ++old;
    if (old == old_contacts.end() || pair_of(*old) != pair) continue;
    const size_t o = old - old_contacts.begin(), count = end_of_pair(old_contacts, o) - o;
    carry_pair(old_contacts.subspan(o, count), impulses.subspan(o, count),
               new_contacts.subspan(n, n_end - n), &carried[n]);
    old += count;
  }
}

}  // namespace

void carry_impulses(std::span<const ContactPoint> old_contacts, std::span<const Vec3> old_impulses,
                    std::span<const ContactPoint> new_contacts, std::vector<Vec3>& carried,
                    WorkerTeam* team) {
  const int count = static_cast<int>(new_contacts.size());
  carried.resize(new_contacts.size());
  run_ranges(team, count, /*together=*/256, [&](int begin, int end) {
    carry_range(old_contacts, old_impulses, new_contacts, begin, end, carried);
  });
}

}  // namespace ballast
