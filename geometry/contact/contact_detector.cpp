#include "geometry/contact/contact_detector.hpp"

#include <algorithm>
#include <stdexcept>
#include <string>

#include "geometry/contact/detection_part.hpp"
#include "platform/worker_team.hpp"

namespace ballast {
namespace {

/// 5 % of the mean circumradius where the scene leaves it open [m].
double chosen_skin(double skin, std::span<const CollisionShape> shapes) {
  if (skin > 0.0 || shapes.empty()) return skin;
  double sum = 0.0;
  for (const CollisionShape& shape : shapes) sum += shape.circumradius();
  return 0.05 * sum / static_cast<double>(shapes.size());
}

std::vector<BroadPhase::Body> broad_phase_bodies(const DetectedBodies& bodies) {
  std::vector<BroadPhase::Body> list;
  for (int i = 0; i < bodies.count(); ++i)
    list.push_back({bodies.shape(i), bodies.shapes[i].fixed});
  return list;
}

}  // namespace

struct ContactDetector::State {
  State(std::vector<ContactShape> shapes, const DetectionSettings& detection)
      : settings(detection),
        bodies(std::move(shapes)),
        broad_phase(broad_phase_bodies(bodies), chosen_skin(settings.skin, bodies.tables)),
        part_of(bodies.shapes.size(), 0) {
    parts.emplace_back(bodies, settings);
    share();
  }

  void check(std::span<const Pose> poses, std::span<const double> reach) const;
  void share();

  DetectionSettings settings;
  DetectedBodies bodies;
  BroadPhase broad_phase;
  WorkerTeam* team = nullptr;
  std::vector<DetectionPart> parts;
  std::vector<int> part_of;  // part that remembers the pairs (a, b) of body a
  DetectionCounters counters;
};

ContactDetector::ContactDetector(std::vector<ContactShape> shapes,
                                 const DetectionSettings& settings)
    : state_(std::make_unique<State>(std::move(shapes), settings)) {}
ContactDetector::~ContactDetector() = default;
ContactDetector::ContactDetector(ContactDetector&&) noexcept = default;
ContactDetector& ContactDetector::operator=(ContactDetector&&) noexcept = default;
const DetectionCounters& ContactDetector::counters() const { return state_->counters; }

void ContactDetector::use_team(WorkerTeam* team, int parts) {
  State& s = *state_;
  s.team = team;
  while (static_cast<int>(s.parts.size()) < parts) s.parts.emplace_back(s.bodies, s.settings);
  s.share();
}

void ContactDetector::detect(std::span<const Pose> poses, std::span<const double> reach,
                             std::vector<ContactPoint>& contacts) {
  State& s = *state_;
  s.check(poses, reach);
  contacts.clear();
  // Rotations of all bodies once, then the pairs that may touch, then each part's run of pairs.
  s.bodies.take(poses, reach);
  const long rebuilds = s.broad_phase.rebuilds();
  s.broad_phase.update(poses, s.bodies.rotations, s.bodies.reach);
  if (s.broad_phase.rebuilds() != rebuilds) s.share();
  run_parts(s.team, static_cast<int>(s.parts.size()), [&](int k) {
    std::vector<ContactPoint>& found = k == 0 ? contacts : s.parts[k].found;
    found.clear();
    s.parts[k].detect(s.broad_phase, found);
  });
  // Part 0 has written to `contacts`; the others' follow in order.
  s.counters = DetectionCounters{};
  s.counters.broad_phase_rebuilds = s.broad_phase.rebuilds();
  for (size_t k = 0; k < s.parts.size(); ++k) {
    s.counters += s.parts[k].counters();
    if (k > 0) contacts.insert(contacts.end(), s.parts[k].found.begin(), s.parts[k].found.end());
  }
}

void ContactDetector::State::check(std::span<const Pose> poses,
                                   std::span<const double> reach) const {
  const size_t count = bodies.shapes.size();
  if (poses.size() != count || reach.size() != count)
    throw std::invalid_argument("detect: " + std::to_string(count) + " bodies, but " +
                                std::to_string(poses.size()) + " poses and " +
                                std::to_string(reach.size()) + " reaches");
  for (size_t i = 0; i < poses.size(); ++i) {
    if (!poses[i].position.allFinite() || !poses[i].rotation.coeffs().allFinite() ||
        !(reach[i] >= 0.0))
      throw std::invalid_argument("detect: pose or reach of body " + std::to_string(i) +
                                  " is not a finite number");
  }
}

/// Deals the bodies out to the parts, so that each has about the same work. The memory of pairs no
/// longer listed is dropped.
void ContactDetector::State::share() {
  // A plane looks at all bodies: as much work as one pair for every 64 of them.
  const size_t plane_work = 1 + bodies.shapes.size() / 64;
  const auto work_of = [&](int a) {
    return (bodies.shape(a) ? 0 : plane_work) +
           static_cast<size_t>(broad_phase.first(a + 1) - broad_phase.first(a));
  };
  size_t total = 0, passed = 0;
  for (int a = 0; a < bodies.count(); ++a) total += work_of(a);
  for (const CandidatePair& pair : broad_phase.pairs())
    if (pair.touching >= 0) parts[part_of[pair.a]].keep(pair);
  for (DetectionPart& part : parts) part.drop_others();
  // Neighbours in the list stay together: a part is a run of bodies, and the parts' contacts, one
  // after the other, are in the order that one part alone would give.
  int begin = 0;
  for (size_t k = 0; k < parts.size(); ++k) {
    int end = begin;
    for (;
         end < bodies.count() && (k + 1 == parts.size() || passed * parts.size() < (k + 1) * total);
         ++end)
      passed += work_of(end);
    const int first = broad_phase.first(begin), last = broad_phase.first(end);
    parts[k].take_range(begin, end, static_cast<size_t>(last - first));
    for (CandidatePair& pair : broad_phase.pairs().subspan(first, last - first))
      if (pair.touching >= 0 && part_of[pair.a] != static_cast<int>(k))
        parts[k].adopt(pair, parts[part_of[pair.a]]);
    begin = end;
  }
  for (size_t k = 0; k < parts.size(); ++k)
    std::fill(part_of.begin() + parts[k].begin(), part_of.begin() + parts[k].end(),
              static_cast<int>(k));
}

}  // namespace ballast
