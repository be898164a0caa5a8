#include "geometry/shape/close_pairs.hpp"

#include <algorithm>

namespace ballast {

std::vector<std::pair<int, int>> close_pairs(std::span<const Vec3> points, double reach) {
  // Close points have close heights along any direction. Along this one no usual set has many
  // equal heights, so that few pairs need be measured.
  const Vec3 direction = Vec3(0.5321, 0.6173, 0.5794).normalized();
  std::vector<std::pair<double, int>> order;
  for (size_t i = 0; i < points.size(); ++i)
    order.emplace_back(direction.dot(points[i] - points[0]), static_cast<int>(i));
  std::sort(order.begin(), order.end());
  std::vector<std::pair<int, int>> pairs;
  for (size_t i = 0; i < order.size(); ++i) {
    // twice the reach: the heights are rounded
    for (size_t j = i + 1; j < order.size() && order[j].first - order[i].first <= 2.0 * reach;
         ++j) {
      const auto [a, b] = std::minmax(order[i].second, order[j].second);
      if ((points[a] - points[b]).norm() <= reach) pairs.emplace_back(a, b);
    }
  }
  return pairs;
}

}  // namespace ballast
