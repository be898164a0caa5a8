#include "geometry/shape/close_pairs.hpp"

#include <algorithm>
#include <bit>
#include <cstdint>
#include <utility>

namespace ballast {
namespace {

/// For each point the smallest index of a point equal to it.
std::vector<int> first_equal(std::span<const Vec3> points) {
  // A table of the points seen so far, each in the first free place from the one that its
  // coordinates' bits name.
  const size_t places = std::bit_ceil(2 * points.size() + 1);
  std::vector<int> table(places, -1), first(points.size());
  for (size_t i = 0; i < points.size(); ++i) {
    std::uint64_t name = 0;
    for (const double x : points[i])
      name = (std::rotl(name, 23) ^ std::bit_cast<std::uint64_t>(x + 0.0)) * 0x9e3779b97f4a7c15u;
    size_t place = (name >> 32) & (places - 1);
    while (table[place] >= 0 && points[static_cast<size_t>(table[place])] != points[i])
      place = (place + 1) & (places - 1);
    if (table[place] < 0) table[place] = static_cast<int>(i);
    first[i] = table[place];
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
