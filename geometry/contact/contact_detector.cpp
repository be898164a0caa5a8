#include "geometry/contact/contact_detector.hpp"

#include <algorithm>
#include <limits>
#include <optional>
#include <stdexcept>
#include <string>
#include <tuple>

#include "geometry/contact/convex_elements.hpp"
#include "geometry/contact/detection_part.hpp"
#include "platform/worker_team.hpp"

namespace ballast {
namespace {

/// The scene's skin or, where the scene leaves it open, 5 % of the mean circumradius [m].
double chosen_skin(double skin, std::span<const CollisionShape> shapes) {
  if (skin > 0.0 || shapes.empty()) return skin;
  double sum = 0.0;
  for (const CollisionShape& shape : shapes) sum += shape.circumradius();
  return 0.05 * sum / static_cast<double>(shapes.size());
}

using Elements = std::optional<ConvexElements>;

DetectedBodies detected_bodies(std::vector<ContactShape> shapes, const Elements& elements) {
  DetectedBodies bodies(elements ? elements->shapes() : std::move(shapes));
  for (int i = 0; elements && i < elements->count(); ++i)
    bodies.is_image[i] = elements->is_image(i);
  return bodies;
}

std::vector<BroadPhase::Body> broad_phase_bodies(const DetectedBodies& bodies,
                                                 const Elements& elements) {
  std::vector<BroadPhase::Body> list;
  for (int i = 0; i < bodies.count(); ++i) {
    list.push_back({bodies.shape(i), bodies.shapes[i].fixed});
    if (!elements) continue;
    list.back().owner = elements->body(i);
    list.back().image = elements->is_image(i);
  }
  return list;
}

}  // namespace

struct ContactDetector::State {
  State(std::vector<ContactShape> shapes, const DetectionSettings& detection, const Period& period)
      : settings(detection),
        body_count(shapes.size()),
        elements(ConvexElements::are_needed(shapes, period)
                     ? std::make_optional<ConvexElements>(shapes, period)
                     : std::nullopt),
        bodies(detected_bodies(std::move(shapes), elements)),
        broad_phase(broad_phase_bodies(bodies, elements),
                    chosen_skin(settings.skin, bodies.tables)) {
    parts.emplace_back(bodies, settings);
    share();
  }

  void check(std::span<const Pose> poses, std::span<const double> reach) const;
  void share();
  void put_together(std::vector<ContactPoint>& contacts);

  DetectionSettings settings;
  size_t body_count;
  Elements elements;  // only where bodies have several parts or the world repeats itself
  DetectedBodies bodies;
  BroadPhase broad_phase;
  WorkerTeam* team = nullptr;
  std::vector<DetectionPart> parts;
  DetectionCounters counters;
};

ContactDetector::ContactDetector(std::vector<ContactShape> shapes,
                                 const DetectionSettings& settings, const Period& period)
    : state_(std::make_unique<State>(std::move(shapes), settings, period)) {}
ContactDetector::~ContactDetector() = default;
const DetectionCounters& ContactDetector::counters() const { return state_->counters; }

void ContactDetector::use_team(WorkerTeam* team, int parts) {
  State& s = *state_;
  s.team = team;
  s.broad_phase.use_team(team);
  while (static_cast<int>(s.parts.size()) < parts) s.parts.emplace_back(s.bodies, s.settings);
  s.share();
}

void ContactDetector::detect(std::span<const Pose> poses, std::span<const double> reach,
                             std::vector<ContactPoint>& contacts, std::span<const Pose> ahead) {
  State& s = *state_;
  s.check(poses, reach);
  if (s.elements) {
    s.elements->place(poses, reach, ahead);
    ahead = s.elements->ahead();
    poses = s.elements->poses();
    reach = s.elements->reach();
  }
  // Computes all rotations once, then the candidate pairs, then the contacts of each part's pairs.
  s.bodies.take(poses, reach, s.team);
  s.bodies.ahead = ahead;
  const long rebuilds = s.broad_phase.rebuilds();
  s.broad_phase.update(poses, s.bodies.rotations, s.bodies.reach);
  if (s.broad_phase.rebuilds() != rebuilds) s.share();
  // A single part writes to `contacts`; the contacts of several are put together in their order.
  const int parts = static_cast<int>(s.parts.size());
  run_parts(s.team, parts, [&](int k) {
    std::vector<ContactPoint>& found = parts == 1 ? contacts : s.parts[k].found;
    found.clear();
    s.parts[k].detect(s.broad_phase, found);
  });
  if (parts > 1) s.put_together(contacts);
  s.counters = DetectionCounters{};
  s.counters.broad_phase_rebuilds = s.broad_phase.rebuilds();
  for (const DetectionPart& part : s.parts)
    for (const auto counter :
         {&DetectionCounters::candidate_pairs, &DetectionCounters::cached_separations,
          &DetectionCounters::proved_axes, &DetectionCounters::full_tests,
          &DetectionCounters::manifolds})
      s.counters.*counter += part.counters().*counter;
  if (s.elements) s.elements->name_bodies(contacts);
}

/// Concatenates the parts' contacts; normally each thread copies those that it has found.
void ContactDetector::State::put_together(std::vector<ContactPoint>& contacts) {
  size_t count = 0;
  for (DetectionPart& part : parts)
    part.first_found = std::exchange(count, count + part.found.size());
  if (count > contacts.capacity()) contacts.reserve(count + count / 8);  // room for later steps
  contacts.resize(count);
  run_parts(team, static_cast<int>(parts.size()), [&](int k) {
    std::ranges::copy(parts[k].found, contacts.begin() + static_cast<long>(parts[k].first_found));
  });
}

void ContactDetector::State::check(std::span<const Pose> poses,
                                   std::span<const double> reach) const {
  if (poses.size() != body_count || reach.size() != body_count)
    throw std::invalid_argument("detect: " + std::to_string(body_count) + " bodies, but " +
                                std::to_string(poses.size()) + " poses and " +
                                std::to_string(reach.size()) + " reaches");
  for (size_t i = 0; i < poses.size(); ++i)
    if (!poses[i].position.allFinite() || !poses[i].rotation.coeffs().allFinite() ||
        !(reach[i] >= 0.0))
      throw std::invalid_argument("detect: pose or reach of body " + std::to_string(i) +
                                  " is not a finite number");
}

/// Deals the bodies out to the parts, so that each has about the same work.
void ContactDetector::State::share() {
  // A plane tests all bodies, which is as much work as one pair for every 64 of them.
  const size_t plane_work = 1 + bodies.shapes.size() / 64;
  const auto work_of = [&](int a) {
    return (bodies.shape(a) ? 0 : plane_work) +
           static_cast<size_t>(broad_phase.first(a + 1) - broad_phase.first(a));
  };
  size_t total = 0, passed = 0;
  for (int a = 0; a < bodies.count(); ++a) total += work_of(a);
  // Each part is a run of neighbours in the list, so that the parts' contacts, one after the other,
  // are in the order that one part alone would give.
  int begin = 0;
  for (size_t k = 0; k < parts.size(); ++k) {
    int end = begin;
    while (end < bodies.count() &&
           (k + 1 == parts.size() || passed * parts.size() < (k + 1) * total))
      passed += work_of(end++);
    parts[k].take_range(begin, end);
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
