#include "geometry/contact/separating_axis.hpp"

#include <algorithm>

namespace ballast {
namespace {

using Lanes = Eigen::Array<double, 8, 1>;

struct Lowest {
  int row;             // smallest index among equals
  double value, next;  // lowest value, and lowest of the other rows
};

Lowest lowest(const double* values, int padded) {
  // The least and second least value of every lane, and then of all lanes together: the larger of
  // two values is a candidate for the second least.
  Lanes least = Eigen::Map<const Lanes>(values);
  Lanes second = Lanes::Constant(1e200);
  for (int i = 8; i < padded; i += 8) {
    const Lanes v = Eigen::Map<const Lanes>(values + i);
    second = second.min(least.max(v));
    least = least.min(v);
  }
  Lowest result{0, least[0], second[0]};
  for (int lane = 1; lane < 8; ++lane) {
    result.next = std::min({result.next, second[lane], std::max(result.value, least[lane])});
    result.value = std::min(result.value, least[lane]);
  }
  while (values[result.row] != result.value) ++result.row;
  return result;
}

/// The cross product of two edges, without its components along them. For nearly parallel edges
/// these components are the only error that matters, as the edges are long in that direction.
Vec3 refined_cross(const Vec3& u, const Vec3& v) {
  Vec3 n = u.cross(v);
  n -= u * (n.dot(u) / u.squaredNorm());
  n -= v * (n.dot(v) / v.squaredNorm());
  return n;
}

}  // namespace

SeparatingAxis edge_axis(const PairFrame& pair, const AxisFeature& feature,
                         const CollisionShape::Edge& a, const CollisionShape::Edge& b,
                         const EdgeSeparation& found) {
  SeparatingAxis axis;
  axis.feature = feature;
  axis.direction = found.direction;
  axis.separation = found.separation;
  const Vec3 between = pair.other[0] * b.from - a.from;
  // The closest points a.from + s a.along and b.from + t along_b differ by a multiple of d, which
  // is across both edges. Cramer's rule with c = a.along x along_b = cross d gives
  //
  //     s = (between x along_b).c / c.c,    t = (between x a.along).c / c.c
  axis.at_a = between.cross(found.along_b).dot(found.direction) / found.cross;
  axis.at_b = between.cross(a.along).dot(found.direction) / found.cross;
  // The facet is the parallelogram of the two edges: the distances to its sides are lengths times
  // the sine of the angle between the edges.
  const double cross = std::abs(found.cross);
  axis.inside = cross * std::min(std::min(axis.at_a, 1.0 - axis.at_a) / b.length,
                                 std::min(axis.at_b, 1.0 - axis.at_b) / a.length);
  axis.clearance = std::min(found.weight_a * a.drop, found.weight_b * b.drop) / cross;
  return axis;
}

FaceSeparation face_separation(const ShapePair& pair, int own, int f, Heights& heights) {
  const CollisionShape::Face face = pair.shape[own]->face(f);
  const AffineRows& vertices = pair.shape[1 - own]->vertices();
  // s(n) = min_B n.x - max_A n.x, and max_A is the face's own offset: only the lowest vertex of the
  // other body over the face is sought.
  vertices.evaluate(pair.other[1 - own].rotation * face.normal, heights.data());
  const Lowest low = lowest(heights.data(), vertices.padded());
  return {face_separation_at(pair, own, face, low.value), low.row, low.next - low.value};
}

std::optional<EdgeSeparation> edge_facet(const PairFrame& pair, const CollisionShape::Edge& a,
                                         const CollisionShape::Edge& b) {
  const RelativePose& b_in_a = pair.other[0];
  const Vec3 along_a = a.along, along_b = b_in_a.rotation * b.along;
  // The arc left -> right of an edge turns around `along`. The arc of a and the reversed arc of b
  // cross where both are perpendicular to both edges: each edge must separate the ends of the
  // other's arc, on the same half of the sphere.
  const double left_a = a.left_normal.dot(along_b), right_a = a.right_normal.dot(along_b);
  if (!(left_a * right_a < 0.0)) return std::nullopt;
  const Vec3 along_a_in_b = pair.other[1].rotation * along_a;
  const double left_b = -b.left_normal.dot(along_a_in_b),
               right_b = -b.right_normal.dot(along_a_in_b);
  if (!(left_b * right_b < 0.0) || !(left_a * right_b > 0.0)) return std::nullopt;

  EdgeSeparation facet;
  facet.along_b = along_b;
  facet.weight_a = std::min(std::abs(left_a), std::abs(right_a));
  facet.weight_b = std::min(std::abs(left_b), std::abs(right_b));
  // Two directions are across both edges, +-along_a x along_b. The one with the plus lies on a's
  // arc from left to right around along_a if left_a > 0. Directions on this arc point out of a.
  const Vec3 cross = along_a.cross(along_b);
  const double sign = left_a > 0.0 ? 1.0 : -1.0, length = cross.norm(),
               sine = length / (a.length * b.length);
  if (sine < parallel_sine) return std::nullopt;
  facet.cross = sign * length;
  facet.nearly_parallel = !(sine > 1e-3);
  if (facet.nearly_parallel) return facet;
  facet.direction = cross / facet.cross;
  facet.separation = facet.direction.dot(b_in_a * b.from - a.from);
  return facet;
}

std::optional<EdgeSeparation> edge_separation(const ShapePair& pair, int ea, int eb,
                                              Heights& heights) {
  const CollisionShape &a = *pair.shape[0], &b = *pair.shape[1];
  const CollisionShape::Edge edge_a = a.edge(ea), edge_b = b.edge(eb);
  std::optional<EdgeSeparation> facet = edge_facet(pair, edge_a, edge_b);
  if (!facet || !facet->nearly_parallel) return facet;
  // The direction of nearly parallel edges is uncertain by rounding / sine: the edges may not be
  // the supports along it. The separation comes from the lowest and highest vertices.
  const double sign = facet->cross > 0.0 ? 1.0 : -1.0;
  facet->direction = sign * refined_cross(edge_a.along, facet->along_b).normalized();
  a.vertices().evaluate(-facet->direction, heights.data());
  const double top_a = -lowest(heights.data(), a.vertices().padded()).value;
  b.vertices().evaluate(pair.other[1].rotation * facet->direction, heights.data());
  const double bottom_b = lowest(heights.data(), b.vertices().padded()).value +
                          facet->direction.dot(pair.other[0].position);
  facet->separation = bottom_b - top_a;
  return facet;
}

std::optional<SeparatingAxis> evaluate_axis(const ShapePair& pair, const AxisFeature& feature,
                                            Heights& heights) {
  if (feature.kind == AxisKind::none) return std::nullopt;
  if (feature.kind == AxisKind::edges) {
    const std::optional<EdgeSeparation> found =
        edge_separation(pair, feature.a, feature.b, heights);
    if (!found) return std::nullopt;
    return edge_axis(pair, feature, pair.shape[0]->edge(feature.a), pair.shape[1]->edge(feature.b),
                     *found);
  }
  const int own = feature.reference(), f = feature.face();
  const FaceSeparation found = face_separation(pair, own, f, heights);
  const CollisionShape& shape = *pair.shape[own];
  SeparatingAxis axis = face_axis(
      pair, feature, shape.face(f), shape.corner_count(f), [&](int k) { return shape.side(f, k); },
      pair.shape[1 - own]->vertices().xyz(found.support), found.separation);
  axis.support = found.support;
  axis.clearance = found.clearance;
  return axis;
}

double face_isolation(const ShapePair& pair, const AxisFeature& feature) {
  if (feature.kind == AxisKind::edges) return 1.0;
  return pair.shape[feature.reference()]->face(feature.face()).isolation;
}

/// Let n0 be the axis, s0 its separation, and n = n0 cos t + e sin t another unit vector, e
/// perpendicular to n0. The facet's corners x_i lie in n0.x = s0, and around the origin's
/// projection out to r = `inside` at least, so some corner has e.x_i <= -r, and s(n) <= min_i n.x_i
/// <= s0 cos t - r sin t. That is below s0 - margin where
///     f(t) = r sin t + s0 (1 - cos t) - margin > 0,
/// and as f > 0 is an interval of t, two ends prove all between. The lower end: within `isolation`
/// of n0 the supports are only the facet's own vertices, so there is no other facet. The upper end:
/// both bodies contain balls, so with c the ball centres' difference s(n) <= n.c - r_a - r_b, and n
/// must lie in a cap around c.
bool is_proved_best(const PairFrame& pair, double face_isolation, const SeparatingAxis& axis) {
  constexpr double isolation = 1e-8;  // [rad]
  const double size = pair.size();
  const double margin =
      proof_margin(pair) + pair.bounds[0]->planarity_error + pair.bounds[1]->planarity_error;
  const double s0 = axis.separation, r = axis.inside;
  if (!(axis.clearance > 4.0 * size * isolation)) return false;
  if (face_isolation < 2.0 * isolation) return false;
  if (!(r * isolation - std::abs(s0) * isolation * isolation > margin)) return false;

  const Vec3 c = pair.other[0] * pair.bounds[1]->ball_centre - pair.bounds[0]->ball_centre;
  const double distance = c.norm();
  const double needed = s0 - margin + pair.bounds[0]->ball_radius + pair.bounds[1]->ball_radius;
  if (!(needed > -distance)) return false;
  // Largest angle from n0 within the cap: the angle n0-c plus the cap's half angle.
  const double cos_c = std::clamp(axis.direction.dot(c) / distance, -1.0, 1.0);
  const double cos_cap = std::clamp(needed / distance, -1.0, 1.0);
  const double sin_c = std::sqrt(1.0 - cos_c * cos_c), sin_cap = std::sqrt(1.0 - cos_cap * cos_cap);
  const double cos_t = cos_c * cos_cap - sin_c * sin_cap, sin_t = sin_c * cos_cap + cos_c * sin_cap;
  // 1e-7: a cosine near 1 determines its angle to 1.5e-8 only.
  return sin_t > 0.0 && r * sin_t + s0 * (1.0 - cos_t) > margin + 1e-7 * size;
}

}  // namespace ballast
