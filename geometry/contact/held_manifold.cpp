#include "geometry/contact/held_manifold.hpp"

#include <cmath>
#include <numbers>

namespace ballast {

void HeldManifold::hold(const ShapePair& pair, const SeparatingAxis& axis,
                        std::span<const ManifoldPoint> points, double reach) {
  count_ = 0;
  if (points.size() > most_points) return;
  const RelativePose& a_in_b = pair.other[1];
  kind_ = axis.feature.kind;
  reach_ = reach;
  b_in_a_ = pair.other[0];
  if (kind_ == AxisKind::face_of_a) first_ = axis.normal;
  if (kind_ == AxisKind::face_of_b) first_ = a_in_b.rotation * axis.normal;
  if (kind_ == AxisKind::edges) {
    first_ = pair.shape[0]->edges()[axis.feature.a].along;
    second_ = pair.shape[1]->edges()[axis.feature.b].along;
    if (first_.cross(b_in_a_.rotation * second_).dot(axis.normal) < 0.0) second_ = -second_;
  }
  for (const ManifoldPoint& point : points) {
    const Vec3 half = 0.5 * point.gap * axis.normal;
    points_[count_++] = {point.key, point.position - half, a_in_b * (point.position + half)};
  }
}

// Rotations by phi against each other: |R - S|_F = 2 sqrt(2) sin(phi/2), and a point at distance 1
// moves by 2 sin(phi/2).
bool HeldManifold::is_valid(const RelativePose& b_in_a, double radius, double alert) const {
  if (count_ == 0) return false;
  const double turn = (b_in_a.rotation - b_in_a_.rotation).norm() / std::numbers::sqrt2;
  return (b_in_a.position - b_in_a_.position).norm() + radius * turn + alert < reach_;
}

std::span<const ManifoldPoint> HeldManifold::points(
    const RelativePose& b_in_a, double alert, Vec3& normal,
    std::array<ManifoldPoint, most_points>& storage) const {
  if (kind_ == AxisKind::face_of_a) normal = first_;
  if (kind_ == AxisKind::face_of_b) normal = b_in_a.rotation * first_;
  if (kind_ == AxisKind::edges) normal = first_.cross(b_in_a.rotation * second_).normalized();
  size_t count = 0;
  for (int k = 0; k < count_; ++k) {
    const Vec3& on_a = points_[k].on_a;
    const Vec3 on_b = b_in_a * points_[k].on_b;
    const double gap = normal.dot(on_b - on_a);
    if (gap > alert) continue;
    // the vertex says where it is; its foot on the face may have slid
    Vec3 position = 0.5 * (on_a + on_b);
    if (kind_ == AxisKind::face_of_a) position = on_b - 0.5 * gap * normal;
    if (kind_ == AxisKind::face_of_b) position = on_a + 0.5 * gap * normal;
    storage[count++] = {points_[k].key, position, gap};
  }
  return {storage.data(), count};
}

}  // namespace ballast
