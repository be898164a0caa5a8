#pragma once
// Sleep: islands at rest are frozen, and neither detected, assembled nor solved until something
// comes near. Not exact; what it neglects stands in docs/theory/method.md.
//
// An island is what contacts within reach join; walls and fixed bodies join nothing. It falls
// asleep when all its bodies have been slower than the limit for long enough, it stands on
// something that cannot move, and nothing acts on it that changes: no driven wall, no wall with
// prescribed motion, no force that varies. It wakes as a whole in the step in which a contact with
// anything awake comes within reach or a force on it changes. Its contacts and impulses stay in the
// StepMemory.

#include <optional>
#include <span>
#include <vector>

#include "experiments/step/step_memory.hpp"
#include "problems/algebra/islands.hpp"
#include "problems/mechanics/mechanical_system.hpp"

namespace ballast {

/// Who sleeps is in the StepMemory; what is kept here can be made again from it and the system.
class RestingIslands {
 public:
  /// `velocity_scale` [m/s]: g h. `system` must outlive this.
  RestingIslands(const MechanicalSystem& system, const SleepSpec& sleep,
                 const DetectionSettings& detection, double velocity_scale);

  /// Begins a step: reads who sleeps; wakes bodies on which a force has changed.
  void begin(StepMemory& memory);

  /// Since begin() or detect().
  bool is_asleep(int body) const { return enabled_ && activity_[body] == Activity::asleep; }

  /// As detector.detect(), but of sleeping bodies only contacts with what is awake; wakes islands
  /// that have one. `detector` knows all bodies; while the same ones sleep another one is used, to
  /// which they are fixed.
  void detect(ContactDetector& detector, std::span<const Pose> poses, std::span<const double> reach,
              StepMemory& memory, std::vector<ContactPoint>& contacts);

  /// The counters of the last detect().
  const DetectionCounters& counters(const ContactDetector& detector) const;

  /// `memory` holds the contacts of detect() with their impulses: adds those that sleepers keep, in
  /// order.
  void restore_kept(StepMemory& memory);
  /// How many of them carry an impulse.
  int kept_active() const;

  /// Ends a step: counts rest, and lets islands fall asleep, whose velocities become zero. Returns
  /// the kinetic energy [J] that this takes away.
  double settle(MotionState& state, StepMemory& memory);

 private:
  enum class Activity : unsigned char {
    still,
    asleep,
    awake
  };  // still: no unknowns, and not moving

  bool is_moving_wall(int body) const;
  bool force_changed(int body);
  void choose_detector();
  void make_calm_detector();
  bool is_kept(const ContactPoint& contact) const;
  void wake_touched(std::span<const ContactPoint> contacts, StepMemory& memory);
  void join(std::span<const ContactPoint> contacts);
  void look_at_islands(const StepMemory& memory);
  bool counts_rest(const MotionState& state, StepMemory& memory) const;

  const MechanicalSystem& system_;
  bool enabled_;
  double velocity_limit_;  // [m/s]
  int steps_;
  DetectionSettings detection_;

  std::vector<char> has_unknowns_;
  std::vector<Activity> activity_, last_activity_;
  std::vector<Vec3> force_;         // on each body when it was last looked at, at t = 0 [N]
  std::vector<char> is_disturbed_;  // by a force that changes
  DisjointSets sets_;
  std::vector<char> flags_;  // by set: what holds of one member and hence of all
  std::vector<ContactPoint> kept_contacts_, merged_contacts_;
  std::vector<Vec3> kept_impulses_, merged_impulses_;

  // a detector to which some of the sleepers are fixed, so that it looks at no pair of them
  std::optional<ContactDetector> calm_;
  std::vector<char> calm_fixed_;
  bool calm_is_used_ = false;
  int calm_steps_ = 0;  // since the sleepers were others
};

}  // namespace ballast
