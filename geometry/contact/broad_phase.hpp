#pragma once
// Candidate pairs of polyhedra: bounding boxes with a margin, listed once and kept until the margin
// is used up.

#include <span>
#include <utility>
#include <vector>

#include "geometry/contact/separating_axis.hpp"
#include "platform/worker_team.hpp"

namespace ballast {

/// Tight box around a shape at a pose, axis-aligned in the world frame [m].
Bounds bounding_box(const CollisionShape& shape, const Mat3& rotation, const Vec3& position);

/// How far a body has moved: no point at distance r from its origin by more than shift + r turn.
/// Added up over steps, the increase since any earlier time bounds the motion since then.
struct Travel {
  double shift = 0.0;  ///< [m]
  double turn = 0.0;   ///< chord of the unit circle [1]
};

/// A bound on a step's motion. The chord of a rotation by phi is 2 sin(phi/2) <= 4 sin(phi/4), and
/// 2 sin(phi/4) is the distance of the unit quaternions.
Travel step_bound(const Pose& from, const Pose& to);

/// Two polyhedra that may touch, a < b, and the memory of their last detection.
struct CandidatePair {
  int a, b;
  AxisFeature axis = {};  ///< the one that decided last time
  int touching = -1;      ///< its record among the pairs that touch; -1: none
  /// Proved separated while shift_a + shift_b + arm_a turn_a + arm_b turn_b + reach_a + reach_b
  /// stays below this [m].
  double apart_below = -1.0;
  double arm_a = 0.0, arm_b = 0.0;  ///< [m]
};

/// The list holds every pair whose boxes, each grown by its body's reach, overlap at the given
/// poses. It may hold more: boxes are listed with a margin, and the list stands as long as no body
/// has used up its margin by moving or by a longer reach. How far bodies have moved is measured on
/// the poses in every call.
class BroadPhase {
 public:
  struct Body {
    const CollisionShape* shape;  ///< not owned; null: left out (planes)
    bool fixed;                   ///< two fixed bodies are never a pair
    int owner = -1;               ///< nor are two of one owner, if they have any
    bool image = false;           ///< nor two images
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

  /// Shares the work of update(); null: alone. The same list either way.
  void use_team(WorkerTeam* team) { team_ = team; }

  /// Sorted by (a, b).
  std::span<CandidatePair> pairs() { return pairs_; }
  std::span<const CandidatePair> pairs() const { return pairs_; }
  /// Pairs with a given a: pairs()[first(a)] to pairs()[first(a + 1)].
  int first(int a) const { return first_[a]; }
  long rebuilds() const { return rebuilds_; }

 private:
  bool still_valid(std::span<const Pose> poses, std::span<const double> reach) const;
  void list_boxes(std::span<const Pose> poses, std::span<const Mat3> rotations,
                  std::span<const double> reach);
  void find_overlaps();
  using Found = std::pair<int, int>;  // bodies a < b whose boxes overlap
  /// Polyhedra that lie beside each other in one direction, by the low end of their boxes in
  /// another.
  struct Strip {
    std::vector<int> bodies;
    std::vector<Found> found;
  };
  template <class IsHere>
  void compare_boxes(Strip& strip, const int (&axis)[3], const IsHere& is_here) const;
  void list_pairs();

  std::vector<Body> bodies_;
  std::vector<double> radius_;  // circumradii, together for the processor's cache [m]
  double skin_;
  std::vector<Pose> listed_pose_;  // when the list was made
  std::vector<double>
      allowance_;              // how far a body's surface may get from there, reach included [m]
  std::vector<Bounds> boxes_;  // grown by the allowance
  std::vector<int> order_;     // polyhedra, by the low end of their boxes
  std::vector<Strip> strips_;
  std::vector<Found> found_;  // in all strips, sorted
  std::vector<CandidatePair> pairs_;
  std::vector<int> first_;
  WorkerTeam* team_ = nullptr;
  long rebuilds_ = 0;
};

}  // namespace ballast
