#include "geometry/contact/held_manifold.hpp"

#include <cmath>
#include <numbers>

namespace ballast {

void HeldManifold::hold(const ShapePair& pair, const SeparatingAxis& axis,
                        std::span<const ManifoldPoint> points, double reach) {
  count_ = 0;
  if (points.size() > most_points) return;
  const RelativePose& a_in_b = pair.other[1];
  carried_ = CarriedContact(pair, axis);
  reach_ = reach;
  b_in_a_ = pair.other[0];
  const Vec3 normal = contact_normal(pair, axis);
  for (const ManifoldPoint& point : points) {
    // The point lies midway: half the gap along the normal on either
    // side is the body's own material.
    const Vec3 half = 0.5 * point.gap * normal;
    points_[count_++] = {point.key, point.position - half, a_in_b * (point.position + half)};
  }
}

// Rotations by phi against each other: |R - S|_F = 2 sqrt(2) sin(phi/2), and a point at distance 1
// moves by 2 sin(phi/2).
bool HeldManifold::is_valid(const RelativePose& b_in_a, double radius, double alert) const {
  if (count_ == 0) return false;
  const double turn = (b_in_a.rotation - b_in_a_.rotation).norm() / std::numbers::sqrt2;
  // Seen from a, no point of b has moved farther than its frame's shift and radius
  // times turn. While that and the asked reach stay below the reach of the search, no
  // point can have come in unseen.
  return (b_in_a.position - b_in_a_.position).norm() + radius * turn + alert < reach_;
}

std::span<const ManifoldPoint> HeldManifold::points(
    const RelativePose& b_in_a, double alert, Vec3& normal,
    std::array<ManifoldPoint, most_points>& storage) const {
  normal = carried_.normal(b_in_a);
  size_t count = 0;
  for (int k = 0; k < count_; ++k) {
    const Point& held = points_[k];
    const ManifoldPoint now = carried_.point(held.key, held.on_a, b_in_a * held.on_b, normal);
    if (now.gap <= alert) storage[count++] = now;
  }
  return {storage.data(), count};
}

}  // namespace ballast
