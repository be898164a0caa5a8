#include "experiments/step/resting_islands.hpp"

#include <algorithm>
#include <tuple>

namespace ballast {
namespace {

constexpr char restless = 1, supported = 2;

/// The same sleepers for so many steps make a detector of their own worth its making.
constexpr int calm_after = 20;
/// And so many of them that the detector at hand does look at: one in this many.
constexpr int calm_share = 8;

bool varies(const ForceSpec& force) {
  return !force.amplitude.isZero(0.0) && force.frequency != 0.0;
}

auto key_of(const ContactPoint& c) { return std::tie(c.body_a, c.body_b, c.feature); }

}  // namespace

RestingIslands::RestingIslands(const MechanicalSystem& system, const SleepSpec& sleep,
                               const DetectionSettings& detection, double velocity_scale)
    : system_(system),
      enabled_(sleep.enabled),
      velocity_limit_(sleep.velocity * velocity_scale),
      steps_(sleep.steps),
      detection_(detection) {
  if (!enabled_) return;
  const size_t count = system.bodies.size();
  for (const RigidBody& body : system.bodies) has_unknowns_.push_back(body.freedom.count() > 0);
  activity_.assign(count, Activity::still);
  is_disturbed_.assign(count, false);
  calm_fixed_.assign(count, false);
}

bool RestingIslands::is_moving_wall(int body) const {
  const RigidBody& b = system_.bodies[body];
  return b.is_wall() && b.wall.motion == WallMotion::prescribed && !b.wall.amplitude.isZero(0.0) &&
         b.wall.frequency != 0.0;
}

/// A force that varies always does. Whoever steps the system may also change it between steps.
bool RestingIslands::force_changed(int body) {
  const RigidBody& b = system_.bodies[body];
  const Vec3 now = b.force.at(0.0) + b.mass * system_.gravity;
  const bool changed = now != force_[body];
  force_[body] = now;
  return changed || varies(b.force);
}

void RestingIslands::begin(StepMemory& memory) {
  if (!enabled_) return;
  const size_t count = system_.bodies.size();
  if (memory.rest.size() != count) memory.rest.assign(count, 0);
  if (force_.empty())
    for (const RigidBody& body : system_.bodies)
      force_.push_back(body.force.at(0.0) + body.mass * system_.gravity);
  for (int b = 0; b < static_cast<int>(count); ++b) {
    if (!has_unknowns_[b]) {
      activity_[b] = is_moving_wall(b) ? Activity::awake : Activity::still;
      continue;
    }
    is_disturbed_[b] = force_changed(b);
    if (is_disturbed_[b]) memory.rest[b] = 0;
    activity_[b] = memory.rest[b] == StepMemory::asleep ? Activity::asleep : Activity::awake;
  }
}

/// Between bodies of which none is awake and one sleeps: not solved for.
bool RestingIslands::is_kept(const ContactPoint& contact) const {
  const Activity a = activity_[contact.body_a], b = activity_[contact.body_b];
  return a != Activity::awake && b != Activity::awake &&
         (a == Activity::asleep || b == Activity::asleep);
}

void RestingIslands::detect(ContactDetector& detector, std::span<const Pose> poses,
                            std::span<const double> reach, StepMemory& memory,
                            std::vector<ContactPoint>& contacts) {
  if (!enabled_) return detector.detect(poses, reach, contacts);
  choose_detector();
  (calm_is_used_ ? *calm_ : detector).detect(poses, reach, contacts);
  const bool wakes = std::any_of(contacts.begin(), contacts.end(), [&](const ContactPoint& c) {
    const Activity a = activity_[c.body_a], b = activity_[c.body_b];
    return (a == Activity::asleep && b == Activity::awake) ||
           (a == Activity::awake && b == Activity::asleep);
  });
  // An awake body that touches a sleeper wakes its whole island.
  if (wakes) {
    if (calm_is_used_)
      detector.detect(poses, reach, contacts);  // whoever wakes needs all its contacts
    calm_is_used_ = false;
    wake_touched(contacts, memory);
  }
  // the calm detector also looks at walls that it must take for movable beside bodies that are not
  std::erase_if(contacts, [&](const ContactPoint& c) {
    return is_kept(c) || (!has_unknowns_[c.body_a] && !has_unknowns_[c.body_b]);
  });
  // Sleepers' contacts are not solved for: they keep the impulses that they fell asleep with.
  kept_contacts_.clear();
  kept_impulses_.clear();
  for (size_t c = 0; c < memory.contacts.size(); ++c) {
    if (!is_kept(memory.contacts[c])) continue;
    kept_contacts_.push_back(memory.contacts[c]);
    kept_impulses_.push_back(memory.impulses[c]);
  }
}

const DetectionCounters& RestingIslands::counters(const ContactDetector& detector) const {
  return calm_is_used_ ? calm_->counters() : detector.counters();
}

/// The calm detector may be used while all that is fixed to it sleeps: of the contacts that it
/// leaves out none is asked for.
void RestingIslands::choose_detector() {
  calm_steps_ = activity_ == last_activity_ ? calm_steps_ + 1 : 0;
  last_activity_ = activity_;
  // Sleepers in all, and those that the detector at hand looks at although they sleep.
  int asleep = 0, looked_at = 0;
  calm_is_used_ = calm_.has_value();
  for (size_t b = 0; b < activity_.size(); ++b) {
    const bool sleeps = activity_[b] == Activity::asleep;
    asleep += sleeps;
    looked_at += sleeps && !(calm_ && calm_fixed_[b]);
    if (calm_ && calm_fixed_[b] && !sleeps) calm_is_used_ = false;
  }
  const bool worth_it = !calm_is_used_ ? asleep > 0 : calm_share * looked_at > asleep;
  if (!worth_it || calm_steps_ < calm_after) return;
  make_calm_detector();
  calm_is_used_ = true;
}

void RestingIslands::make_calm_detector() {
  // of two bodies fixed to it the detector looks at no pair
  std::vector<ContactShape> shapes = contact_shapes(system_);
  for (size_t b = 0; b < shapes.size(); ++b) {
    const RigidBody& body = system_.bodies[b];
    calm_fixed_[b] = activity_[b] == Activity::asleep;
    // a wall of prescribed motion is fixed to the other detector, which never lacks a pair by it
    if (body.is_wall() && body.wall.motion == WallMotion::prescribed) shapes[b].fixed = false;
    if (calm_fixed_[b]) shapes[b].fixed = true;
  }
  calm_.emplace(std::move(shapes), detection_);
}

/// Islands: bodies with unknowns that touch, directly or through others.
void RestingIslands::join(std::span<const ContactPoint> contacts) {
  sets_.reset(static_cast<int>(activity_.size()));
  for (const ContactPoint& c : contacts)
    if (has_unknowns_[c.body_a] && has_unknowns_[c.body_b]) sets_.join(c.body_a, c.body_b);
  flags_.assign(activity_.size(), 0);
}

/// One awake member wakes the whole island: sleepers' contacts are not solved, so none may be
/// pushed.
void RestingIslands::wake_touched(std::span<const ContactPoint> contacts, StepMemory& memory) {
  join(contacts);
  for (const ContactPoint& c : contacts) {
    if (activity_[c.body_a] != Activity::awake && activity_[c.body_b] != Activity::awake) continue;
    for (const int body : {c.body_a, c.body_b})
      if (has_unknowns_[body]) flags_[sets_.find(body)] = restless;
  }
  for (int b = 0; b < static_cast<int>(activity_.size()); ++b) {
    if (activity_[b] != Activity::asleep || flags_[sets_.find(b)] != restless) continue;
    activity_[b] = Activity::awake;
    memory.rest[b] = 0;
  }
}

void RestingIslands::restore_kept(StepMemory& memory) {
  if (!enabled_ || kept_contacts_.empty()) return;
  merged_contacts_.clear();
  merged_impulses_.clear();
  const auto take = [&](const std::vector<ContactPoint>& contacts,
                        const std::vector<Vec3>& impulses, size_t& k) {
    merged_contacts_.push_back(contacts[k]);
    merged_impulses_.push_back(impulses[k++]);
  };
  // Both lists are sorted by key, and so is what they are merged into.
  size_t k = 0;
  for (size_t c = 0; c < memory.contacts.size();) {
    if (k < kept_contacts_.size() && key_of(kept_contacts_[k]) < key_of(memory.contacts[c]))
      take(kept_contacts_, kept_impulses_, k);
    else
      take(memory.contacts, memory.impulses, c);
  }
  while (k < kept_contacts_.size()) take(kept_contacts_, kept_impulses_, k);
  memory.contacts.swap(merged_contacts_);
  memory.impulses.swap(merged_impulses_);
}

int RestingIslands::kept_active() const {
  return static_cast<int>(std::count_if(kept_impulses_.begin(), kept_impulses_.end(),
                                        [](const Vec3& r) { return !r.isZero(0.0); }));
}

/// True if someone has been at rest for long enough.
bool RestingIslands::counts_rest(const MotionState& state, StepMemory& memory) const {
  bool enough = false;
  for (size_t b = 0; b < activity_.size(); ++b) {
    const RigidBody& body = system_.bodies[b];
    if (!has_unknowns_[b] || body.is_wall() || activity_[b] == Activity::asleep) continue;
    // |v| + |w| R bounds the speed of every point of the body.
    const double speed =
        state.velocity[b].norm() + state.spin[b].norm() * body.shape.polyhedron->circumradius();
    // One step of motion begins the count anew.
    const bool rests = speed <= velocity_limit_ && !is_disturbed_[b];
    memory.rest[b] = rests ? std::min(memory.rest[b] + 1, steps_) : 0;
    enough = enough || memory.rest[b] >= steps_;
  }
  return enough;
}

/// An island sleeps when all of it has been at rest for long enough and something still holds it.
void RestingIslands::look_at_islands(const StepMemory& memory) {
  join(memory.contacts);
  for (int b = 0; b < static_cast<int>(activity_.size()); ++b)
    if (has_unknowns_[b] && memory.rest[b] < steps_ && memory.rest[b] != StepMemory::asleep)
      flags_[sets_.find(b)] |= restless;
  // A body without unknowns supports the island, unless it is a wall that moves.
  for (const ContactPoint& c : memory.contacts) {
    const int other = has_unknowns_[c.body_a] ? c.body_b : c.body_a;
    if (has_unknowns_[other]) continue;
    const int body = other == c.body_a ? c.body_b : c.body_a;
    flags_[sets_.find(body)] |= activity_[other] == Activity::awake ? restless : supported;
  }
}

double RestingIslands::settle(MotionState& state, StepMemory& memory) {
  if (!enabled_ || !counts_rest(state, memory)) return 0.0;
  look_at_islands(memory);
  double energy = 0.0;
  for (int b = 0; b < static_cast<int>(activity_.size()); ++b) {
    if (activity_[b] != Activity::awake || !has_unknowns_[b] || flags_[sets_.find(b)] != supported)
      continue;
    energy += kinetic_energy(system_.bodies[b], state.velocity[b], state.spin[b]);
    state.velocity[b].setZero();
    state.spin[b].setZero();
    memory.rest[b] = StepMemory::asleep;
  }
  return energy;
}

}  // namespace ballast
