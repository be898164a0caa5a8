#pragma once
// Candidate pairs of polyhedra, from bounding boxes with a margin. The list is made once and kept
// until the margin is used up.

#include <mutex>
#include <span>
#include <utility>
#include <vector>

#include "geometry/contact/touching_pair.hpp"
#include "platform/worker_team.hpp"

namespace ballast {

/// Tight box around a shape at a pose, axis-aligned in the world frame [m].
Bounds bounding_box(const CollisionShape& shape, const Mat3& rotation, const Vec3& position);

/// A bound on a body's motion: a point at distance r from its origin moves by at most shift + r
/// turn. Summed over steps, its increase since any earlier time bounds the motion since then.
struct MotionBound {
  double shift = 0.0;  ///< [m]
  double turn = 0.0;   ///< chord of the unit circle [1]
};

/// A bound on a step's motion.
MotionBound step_bound(const Pose& from, const Pose& to);

/// Two polyhedra that may touch, a < b, and the memory of their last detection.
struct CandidatePair {
  int a, b;
  AxisFeature axis = {};  ///< the facet that decided last time
  int touching = -1;      ///< place of its memory, BroadPhase::memory(); -1: it has not touched
  /// The pair is proved separated while shift_a + shift_b + arm_a turn_a + arm_b turn_b + reach_a +
  /// reach_b stays below this [m].
  double apart_below = -1.0;
  double arm_a = 0.0, arm_b = 0.0;  ///< [m]
};

/// The list holds every pair whose boxes, each grown by its body's reach, overlap at the given
/// poses. It may hold more pairs: boxes are listed with a margin, and the list stays valid until a
/// body has used up its margin by moving or by a longer reach. Every call measures on the poses how
/// far the bodies have moved.
class BroadPhase {
 public:
  struct Body {
    const CollisionShape* shape;  ///< not owned; null: left out (planes)
    bool fixed;                   ///< two fixed bodies are never a pair
    int owner = -1;               ///< two bodies of one owner are never a pair; -1: no owner
    bool image = false;           ///< two images are never a pair
    bool meets(const Body& other) const {
      return !(fixed && other.fixed) && (owner < 0 || owner != other.owner) &&
             !(image && other.image);
    }
  };

  /// `skin` [m]: least sum of the margins of two bodies.
  BroadPhase(std::vector<Body> bodies, double skin);

  /// Brings the list up to date; pairs that stay keep their memory. `rotations`: R_WB of the poses.
  /// `reach`: how far any point of each body may get until the next call [m].
  void update(std::span<const Pose> poses, std::span<const Mat3> rotations,
              std::span<const double> reach);

  /// `team` shares the work of update(); null: the caller works alone. The list is the same.
  void use_team(WorkerTeam* team) { team_ = team; }

  /// The candidate pairs, sorted by (a, b).
  std::span<CandidatePair> pairs() { return pairs_; }
  std::span<const CandidatePair> pairs() const { return pairs_; }
  /// The pairs with a given a are pairs()[first(a)] to before pairs()[first(a + 1)].
  int first(int a) const { return first_[a]; }
  long rebuilds() const { return rebuilds_; }

  /// The memory at CandidatePair::touching.
  TouchingPair& memory(int place) { return memories_[place]; }
  /// Returns a place for the memory of a pair that begins to touch. Several threads may call it at
  /// the same time.
  int new_place();

 private:
  bool still_valid(std::span<const Pose> poses, std::span<const double> reach) const;
  void list_boxes(std::span<const Pose> poses, std::span<const Mat3> rotations,
                  std::span<const double> reach);
  void find_overlaps();
  using Found = std::pair<int, int>;  // bodies a < b whose boxes overlap
  /// The polyhedra whose boxes reach into a strip across one direction, sorted by the low end of
  /// their boxes along another.
  struct Strip {
    std::vector<int> bodies;
    std::vector<Found> found;
  };
  template <class IsHere>
  void compare_boxes(Strip& strip, const int (&axis)[3], const IsHere& is_here) const;
  void list_pairs();

  std::vector<Body> bodies_;
  std::vector<double> radius_;  // circumradii [m], side by side for the processor's cache
  double skin_;
  std::vector<Pose> listed_pose_;  // poses when the list was made
  std::vector<double> allowance_;  // how far surfaces may get from listed_pose_, with reach [m]
  std::vector<Bounds> boxes_;      // grown by the allowance
  std::vector<int> order_;         // polyhedra, sorted by the low end of their boxes
  std::vector<Strip> strips_;
  std::vector<Found> found_;  // pairs found in all strips, sorted
  std::vector<CandidatePair> pairs_;
  std::vector<int> first_;
  // Memories stay at their places; those of pairs that have left the list are vacant.
  std::vector<TouchingPair> memories_;
  std::vector<int> vacant_;
  std::mutex place_mutex_;
  WorkerTeam* team_ = nullptr;
  long rebuilds_ = 0;
};

}  // namespace ballast
