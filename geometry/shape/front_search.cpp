#include "geometry/shape/front_search.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

namespace ballast {
FrontSearch::FrontSearch(std::span<const Vec3> points) : points_(points), order_(points.size()) {
  std::iota(order_.begin(), order_.end(), 0);
  if (!order_.empty()) build(0, static_cast<int>(order_.size()));
}

/// Nodes are stored in the order of a depth-first walk. The first child stands right behind its
/// parent, and `after` is where the walk goes on when a node is passed over:
///
///         0           node    0  1  2  3  4
///       1   4         after   5  4  3  4  5
///      2 3
void FrontSearch::build(int begin, int end) {
  const size_t self = nodes_.size();
  nodes_.push_back(enclosing(begin, end));
  if (end - begin > leaf_size) {
    // Halves along the axis in which the points extend farthest.
    Vec3 low = points_[static_cast<size_t>(order_[static_cast<size_t>(begin)])], high = low;
    for (int i = begin; i < end; ++i) {
      const Vec3& p = points_[static_cast<size_t>(order_[static_cast<size_t>(i)])];
      low = low.cwiseMin(p);
      high = high.cwiseMax(p);
    }
    Eigen::Index axis;
    (high - low).maxCoeff(&axis);
    const int middle = begin + (end - begin) / 2;
    std::nth_element(
        order_.begin() + begin, order_.begin() + middle, order_.begin() + end, [&](int a, int b) {
          return points_[static_cast<size_t>(a)][axis] < points_[static_cast<size_t>(b)][axis];
        });
    build(begin, middle);
    build(middle, end);
  }
  nodes_[self].after = static_cast<int>(nodes_.size());
}

/// The slab lies across the direction in which the points scatter least.
FrontSearch::Node FrontSearch::enclosing(int begin, int end) const {
  Node node{begin, end, 0, Vec3::Zero(), Vec3::UnitX(), 0.0, 0.0, 0.0};
  const auto point = [&](int i) -> const Vec3& {
    return points_[static_cast<size_t>(order_[static_cast<size_t>(i)])];
  };
  for (int i = begin; i < end; ++i) node.centre += point(i) / static_cast<double>(end - begin);
  Mat3 scatter = Mat3::Zero();
  for (int i = begin; i < end; ++i)
    scatter += (point(i) - node.centre) * (point(i) - node.centre).transpose();
  // The direction of least scatter belongs to the smallest eigenvalue of sum d d', d = p - centre.
  // Eigen lists eigenvalues in ascending order.
  node.slab_normal = Eigen::SelfAdjointEigenSolver<Mat3>(scatter).eigenvectors().col(0);
  for (int i = begin; i < end; ++i) {
    const Vec3 arm = point(i) - node.centre;
    const double height = node.slab_normal.dot(arm);
    node.low = std::min(node.low, height);
    node.high = std::max(node.high, height);
    node.radius = std::max(node.radius, arm.norm());
  }
  return node;
}

/// The highest that a point of the slab and the ball can be: across the slab, and along it. For
/// p = centre + h m + t with m the slab's normal, t within the slab and |t| <= radius:
/// direction.p <= direction.centre + max(across low, across high) + along radius.
double FrontSearch::highest(const Node& node, const Vec3& direction, const Vec3& origin) {
  const double across = direction.dot(node.slab_normal);
  const double along = (direction - across * node.slab_normal).norm();
  const Vec3 arm = node.centre - origin;
  constexpr double epsilon = std::numeric_limits<double>::epsilon();
  const double rounding = 16.0 * epsilon * direction.norm() * (arm.norm() + node.radius);
  return direction.dot(arm) + std::max(across * node.low, across * node.high) +
         along * node.radius + rounding;
}

}  // namespace ballast
