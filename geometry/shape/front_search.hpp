#pragma once
// Points in front of a plane, found without looking at all of them.

#include <span>
#include <vector>

#include "geometry/shape/pose.hpp"

namespace ballast {

/// A tree over points. Each node knows a slab between two parallel planes that holds its points: on
/// a flat or gently curved surface the slabs are thin, and hardly any need be opened for the plane
/// of one of the surface's own faces.
class FrontSearch {
 public:
  /// The points must outlive it.
  explicit FrontSearch(std::span<const Vec3> points);

  /// Whether a point has normal.(point - origin) > height [m]. `normal`: of length 1.
  bool any_in_front(const Vec3& normal, const Vec3& origin, double height) const;

 private:
  struct Node {
    int begin, end;  // its points in order_
    int after;       // the node behind it and all below it; begin + 1 is its first child
    Vec3 centre, slab_normal;
    double low, high, radius;  // of the slab from the centre; of the ball around it
  };
  void build(int begin, int end);
  Node enclosing(int begin, int end) const;

  std::span<const Vec3> points_;
  std::vector<int> order_;
  std::vector<Node> nodes_;  // parents before children, first child next
};

}  // namespace ballast
