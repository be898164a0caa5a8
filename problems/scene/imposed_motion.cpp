// The values and rates of imposed motions.

#include <algorithm>

#include "problems/scene/scene.hpp"

namespace ballast {
namespace {

/// The first row after t.
template <class Value>
auto row_after(const std::vector<std::pair<double, Value>>& table, double t) {
  return std::ranges::upper_bound(table, t, {}, [](const auto& row) { return row.first; });
}

/// d/dt between the row before `after` and that row.
template <class Row>
auto slope(const Row& after) {
  const auto& [t0, x0] = *(after - 1);
  const auto& [t1, x1] = *after;
  return (1.0 / (t1 - t0)) * (x1 - x0);
}

}  // namespace

template <class Value>
Value TimeFunction<Value>::at(double t) const {
  const double omega = 2.0 * std::numbers::pi * frequency;
  Value value = t * rate + (1.0 - std::cos(omega * t)) * amplitude;
  if (table.empty()) return value;
  const auto after = row_after(table, t);
  if (after == table.begin()) return value + table.front().second;
  value += (after - 1)->second;
  if (after != table.end()) value += (t - (after - 1)->first) * slope(after);
  return value;
}

template <class Value>
Value TimeFunction<Value>::rate_at(double t) const {
  const double omega = 2.0 * std::numbers::pi * frequency;
  Value value = rate + amplitude * (omega * std::sin(omega * t));
  const auto after = row_after(table, t);
  if (after != table.begin() && after != table.end()) value += slope(after);
  return value;
}

template struct TimeFunction<double>;
template struct TimeFunction<Vec3>;

Pose ImposedMotion::pose_at(double t, const Pose& start) const {
  const Quat turned = rotation_by(turn.at(t) * axis);
  return {centre + shift.at(t) + turned * (start.position - centre),
          (turned * start.rotation).normalized()};
}

Vec3 ImposedMotion::velocity_at(double t, const Vec3& place) const {
  return shift.rate_at(t) + spin_at(t).cross(place - centre - shift.at(t));
}

}  // namespace ballast
