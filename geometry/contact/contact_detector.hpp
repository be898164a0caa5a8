#pragma once
// Shapes and poses -> contact points, in one call per step: candidate pairs (broad_phase.hpp), the
// best axis of each (axis_search.hpp), then normal, gaps and points (contact_normal.hpp). Also
// carries last step's impulses to this step's contact points by feature key.

#include <optional>
#include <span>
#include <vector>

#include "geometry/contact/convex_elements.hpp"
#include "geometry/contact/detection_part.hpp"

namespace ballast {

/// Contact detection for one set of bodies, of one or several convex parts, with a memory from step
/// to step. The memory makes it fast and does not change the result: contacts depend only on what
/// detect() is given. They are sorted by (body_a, body_b, feature).
class ContactDetector {
 public:
  /// Throws std::invalid_argument as ConvexElements.
  ContactDetector(std::vector<ContactShape> shapes, const DetectionSettings& settings,
                  const Period& period = {});

  /// poses[i]: pose of body i. reach[i] [m]: bound on how far any point of body i moves until the
  /// next detection. A point is reported when its gap <= reach[a] + reach[b]. `contacts` is
  /// overwritten; no allocation once it has grown. `ahead`: the poses at the next detection if
  /// nothing is met. With them a body passes edges of fixed bodies that would not stop it.
  void detect(std::span<const Pose> poses, std::span<const double> reach,
              std::vector<ContactPoint>& contacts, std::span<const Pose> ahead = {});

  const DetectionCounters& counters() const { return counters_; }

  /// Lets `team`, which must outlive the detector, do the work in at least `parts` parts (null: the
  /// caller works alone). The contacts do not depend on the number of parts.
  void use_team(WorkerTeam* team, int parts);

 private:
  void check(std::span<const Pose> poses, std::span<const double> reach) const;
  void share();
  void put_together(std::vector<ContactPoint>& contacts);

  DetectionSettings settings_;
  size_t body_count_;
  std::optional<ConvexElements> elements_;  // where bodies have parts or the world repeats itself
  DetectedBodies bodies_;
  BroadPhase broad_phase_;
  WorkerTeam* team_ = nullptr;
  std::vector<DetectionPart> parts_;  // they refer to bodies_ and settings_
  DetectionCounters counters_;
};

// ---- warm starts

/// Carries one world-frame vector (an impulse on body b [N s]) per contact point from a step to the
/// next.
///
/// Both contact lists are sorted by (body_a, body_b, feature), so that one merge matches them. The
/// impulse of a point whose key has gone goes to the nearest unmatched new point of the same pair,
/// or to the nearest of all if every one is matched. A pair that stays thus keeps its sum; a pair
/// that has gone loses its impulse. `carried` is resized to the new contacts; points without a past
/// get zero. No allocation once grown. `team` shares the work; null: the caller works alone.
void carry_impulses(std::span<const ContactPoint> old_contacts, std::span<const Vec3> old_impulses,
                    std::span<const ContactPoint> new_contacts, std::vector<Vec3>& carried,
                    WorkerTeam* team = nullptr);

}  // namespace ballast
