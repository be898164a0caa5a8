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

  /// Planes whose normals differ by at most `spread` from `normal`, taken together: points are in
  /// front where normal.(p - origin) + spread |p - origin| > height. Roundings are the caller's.
  struct Cone {
    Vec3 normal, origin;
    double spread, height;  // [-], [m]
    bool has_in_front(const Vec3& p) const {
      const Vec3 arm = p - origin;
      const double gap = height - normal.dot(arm);
      return gap < 0.0 || spread * spread * arm.squaredNorm() > gap * gap;
    }
  };

  /// visit(i) for the points in front, until it answers false.
  template <typename Visit>
  void visit_in_front(const Cone& cone, Visit&& visit) const {
    for (size_t at = 0; at < nodes_.size();) {
      const Node& node = nodes_[at];
      if (highest(node, cone) <= cone.height) {
        at = static_cast<size_t>(node.after);
        continue;
      }
      // Only leaves look at their points; behind an inner node stands its first child.
      if (is_leaf(node))
        for (int k = node.begin; k < node.end; ++k) {
          const int i = order_[static_cast<size_t>(k)];
          if (cone.has_in_front(points_[static_cast<size_t>(i)]) && !visit(i)) return;
        }
      ++at;
    }
  }

  /// visit(i) for the points that may be higher than `floor` along `direction` (of any length):
  /// higher than visit's last answer, the new floor. For who looks for the highest point, in a
  /// sense of its own.
  template <typename Visit>
  void visit_higher(const Vec3& direction, double floor, Visit&& visit) const {
    for (size_t at = 0; at < nodes_.size();) {
      const Node& node = nodes_[at];
      if (highest(node, direction, Vec3::Zero()) <= floor) {
        at = static_cast<size_t>(node.after);
        continue;
      }
      if (is_leaf(node))
        for (int i = node.begin; i < node.end; ++i) floor = visit(order_[static_cast<size_t>(i)]);
      ++at;
    }
  }

 private:
  struct Node {
    int begin, end;  // its points in order_
    int after;       // the node behind it and all below it; begin + 1 is its first child
    Vec3 centre, slab_normal;
    double low, high, radius;  // of the slab from the centre; of the ball around it
  };
  static constexpr int leaf_size = 16;
  static bool is_leaf(const Node& node) { return node.end - node.begin <= leaf_size; }
  /// What direction.(p - origin) is at most for the points of a node, computed with roundings.
  static double highest(const Node& node, const Vec3& direction, const Vec3& origin);
  static double highest(const Node& node, const Cone& cone) {
    const double reach = (node.centre - cone.origin).norm() + node.radius;
    return highest(node, cone.normal, cone.origin) + cone.spread * reach;
  }
  void build(int begin, int end);
  Node enclosing(int begin, int end) const;

  std::span<const Vec3> points_;
  std::vector<int> order_;
  std::vector<Node> nodes_;  // parents before children, first child next
};

}  // namespace ballast
