#include "geometry/shape/close_pairs.hpp"

#include <algorithm>
#include <numeric>
#include <tuple>
#include <utility>

namespace ballast {
namespace {

/// For each point the smallest index of a point equal to it.
std::vector<int> first_equal(std::span<const Vec3> points) {
  // Sorted by coordinates and then by index, equal points stand in runs that
  // begin with the smallest index.
  std::vector<int> order(points.size());
  std::iota(order.begin(), order.end(), 0);
  const auto key = [&](int i) {
    const Vec3& p = points[static_cast<size_t>(i)];
    return std::tuple(p.x(), p.y(), p.z(), i);
  };
  std::sort(order.begin(), order.end(), [&](int a, int b) { return key(a) < key(b); });
  std::vector<int> first(points.size());
  for (size_t i = 0, run = 0; i < order.size(); ++i) {
    if (points[static_cast<size_t>(order[i])] != points[static_cast<size_t>(order[run])]) run = i;
    first[static_cast<size_t>(order[i])] = order[run];
  }
  return first;
}

}  // namespace

std::vector<int> first_close(std::span<const Vec3> points, double reach) {
  std::vector<int> first = first_equal(points);
  // Close points have close heights along any direction. Along this one no usual set has many
  // equal heights, so that few pairs need be measured. One of each set of equal points stands for
  // all.
  const Vec3 direction = Vec3(0.5321, 0.6173, 0.5794).normalized();
  std::vector<std::pair<double, int>> order;
  for (size_t i = 0; i < points.size(); ++i)
    if (first[i] == static_cast<int>(i))
      order.emplace_back(direction.dot(points[i] - points[0]), static_cast<int>(i));
  std::sort(order.begin(), order.end());
  std::vector<int> nearest = first;
  for (size_t i = 0; i < order.size(); ++i) {
    // twice the reach: the heights are rounded
    for (size_t j = i + 1; j < order.size() && order[j].first - order[i].first <= 2.0 * reach;
         ++j) {
      const auto [a, b] = std::minmax(order[i].second, order[j].second);
      int& found = nearest[static_cast<size_t>(b)];
      if ((points[static_cast<size_t>(a)] - points[static_cast<size_t>(b)]).norm() <= reach)
        found = std::min(found, a);
    }
  }
  // Equal points have the same points close to them.
  for (size_t i = 0; i < points.size(); ++i) nearest[i] = nearest[static_cast<size_t>(first[i])];
  return nearest;
}

}  // namespace ballast
