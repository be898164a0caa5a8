#pragma once
// A pair's contact points held on to while its bodies have hardly moved against each other. Each
// point stays on the material of both bodies, and the normal turns with the features that define it
// (CarriedContact). Meanwhile no search asks whether another axis has become the best one: this
// saves time at the price of exactness, and is therefore off by default
// (DetectionSettings::reuse_motion).

#include <array>
#include <span>

#include "geometry/contact/contact_normal.hpp"

namespace ballast {

class HeldManifold {
 public:
  static constexpr int most_points = 4;  ///< manifolds with more are not held

  /// Takes the points that the pair's axis gave: all those with gap <= reach [m].
  void hold(const ShapePair& pair, const SeparatingAxis& axis,
            std::span<const ManifoldPoint> points, double reach);
  void drop() { count_ = 0; }

  /// True if no point of b (distances from its origin up to `radius`), seen from a, has moved so
  /// far since hold() that a point left out then could have a gap <= alert now [m].
  bool is_valid(const RelativePose& b_in_a, double radius, double alert) const;

  /// The points with gap <= alert at this relative pose, in a's frame, and their normal from a to
  /// b. Gaps are exact where a vertex meets a face or two edges cross. Corners of the common part
  /// of two faces are taken for points of both bodies: their gaps err by the distance slid times
  /// the angle between the faces.
  std::span<const ManifoldPoint> points(const RelativePose& b_in_a, double alert, Vec3& normal,
                                        std::array<ManifoldPoint, most_points>& storage) const;

 private:
  struct Point {
    std::uint64_t key;
    Vec3 on_a, on_b;  ///< each in its body's frame [m]
  };
  CarriedContact carried_;
  int count_ = 0;
  double reach_ = 0.0;
  RelativePose b_in_a_;  ///< when the points were taken
  std::array<Point, most_points> points_;
};

}  // namespace ballast
