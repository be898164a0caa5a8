#include "geometry/shape/point_sets.hpp"

#include <algorithm>
#include <numeric>
#include <utility>

namespace ballast {

Bounds bounds_of(std::span<const Vec3> points) {
  Bounds bounds{points[0], points[0]};
  for (const Vec3& p : points) {
    bounds.low = bounds.low.cwiseMin(p);
    bounds.high = bounds.high.cwiseMax(p);
  }
  return bounds;
}

std::vector<int> first_close(std::span<const Vec3> points, double reach) {
  // Close points have close heights along any direction. Along this one no usual set has many
  // equal heights, so that few pairs need be measured.
  const Vec3 direction = Vec3(0.5321, 0.6173, 0.5794).normalized();
  std::vector<std::pair<double, int>> order;
  for (size_t i = 0; i < points.size(); ++i)
    order.emplace_back(direction.dot(points[i] - points[0]), static_cast<int>(i));
  std::sort(order.begin(), order.end());
  std::vector<int> first(points.size());
  std::iota(first.begin(), first.end(), 0);
  for (size_t i = 0; i < order.size(); ++i) {
    // twice the reach: the heights are rounded
    for (size_t j = i + 1; j < order.size() && order[j].first - order[i].first <= 2.0 * reach;
         ++j) {
      const auto [a, b] = std::minmax(order[i].second, order[j].second);
      if ((points[a] - points[b]).norm() <= reach) first[b] = std::min(first[b], a);
    }
  }
  return first;
}

}  // namespace ballast
