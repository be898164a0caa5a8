#pragma once
// Candidate pairs of polyhedra: bounding boxes with a margin, listed once and kept until the margin is used up.

#include <span>
#include <vector>

#include "geometry/separating_axis.hpp"

namespace ballast {

/// Axis-aligned, world frame [m].
struct Box {
  Vec3 low, high;
};

/// Tight box around a shape at a pose.
Box bounding_box(const CollisionShape& shape, const Mat3& rotation, const Vec3& position);

/// Two polyhedra that may touch, a < b, and what is remembered of them.
struct CandidatePair {
  int a, b;
  AxisFeature axis;  ///< last step's
};

/// The list holds every pair whose boxes, each grown by its body's reach, overlap at the given poses. It may hold more:
/// boxes are listed with a margin, and the list stands as long as no body has used up its margin by moving or by a
/// longer reach. How far bodies have moved is measured on the poses in every call.
class BroadPhase {
 public:
  struct Body {
    const CollisionShape* shape;  ///< not owned; null: left out (planes)
    bool fixed;                   ///< two fixed bodies are never a pair
  };

  /// `skin` [m]: least sum of the margins of two bodies.
  BroadPhase(std::vector<Body> bodies, double skin);

  /// Brings the list up to date; remembered axes are carried over. `rotations`: R_WB of the poses.
  void update(std::span<const Pose> poses, std::span<const Mat3> rotations, std::span<const double> reach);

  /// Sorted by (a, b).
  std::span<CandidatePair> pairs() { return pairs_; }
  /// Pairs with a given a: pairs()[first(a)] to pairs()[first(a + 1)].
  int first(int a) const { return first_[a]; }
  long rebuilds() const { return rebuilds_; }

 private:
  bool still_valid(std::span<const Pose> poses, std::span<const double> reach) const;
  void grow_boxes(std::span<const Pose> poses, std::span<const Mat3> rotations, std::span<const double> reach);
  void sweep();
  void sort_pairs();
  void carry_axes();

  std::vector<Body> bodies_;
  double skin_;
  std::vector<Pose> listed_pose_;  // when the list was made
  std::vector<double> allowance_;  // how far a body's surface may get from there, reach included [m]
  std::vector<Box> boxes_;         // grown by the allowance
  std::vector<int> order_;         // polyhedra, by the low end of their boxes
  std::vector<std::pair<int, int>> found_;
  std::vector<CandidatePair> pairs_, old_pairs_;
  std::vector<int> first_;
  long rebuilds_ = 0;
};

}  // namespace ballast
