#include "geometry/contact_manifold.hpp"

#include <algorithm>
#include <cmath>

namespace ballast {
namespace {

/// The face of the other body, among those at its touching vertex, that opposes the reference face most. Near-ties go
/// to the smallest index: rounding must not choose.
int incident_face(const ShapePair& pair, int reference, int face, int vertex) {
  const CollisionShape& other = *pair.shape[1 - reference];
  const Vec3 direction = pair.other[1 - reference].rotation * pair.shape[reference]->face(face).normal;
  int incident = -1;
  double most_opposed = 2.0;
  for (const int f : other.vertex_faces(vertex)) {
    const double cosine = other.face(f).normal.dot(direction);
    if (cosine >= most_opposed - 1e-12) continue;
    most_opposed = cosine;
    incident = f;
  }
  return incident;
}

ClippedPoint touching_vertex(const ShapePair& pair, int reference, int face, int vertex) {
  const CollisionShape::Face& plane = pair.shape[reference]->face(face);
  ClippedPoint point;
  point.position = pair.other[reference] * pair.shape[1 - reference]->vertices().xyz(vertex);
  point.height = plane.normal.dot(point.position) - plane.offset;
  point.key =
      reference == 0 ? feature_key(PointKind::vertex_of_b, 0, vertex) : feature_key(PointKind::vertex_of_a, vertex, 0);
  point.next_edge = -1;
  return point;
}

/// The face beside an edge that looks along d most. The edge's record knows both normals: the faces' are left alone.
struct BesideEdge {
  int face;
  double cosine;
};
BesideEdge most_aligned(const CollisionShape::Edge& edge, const Vec3& d) {
  const double left = edge.left_normal.dot(d), right = edge.right_normal.dot(d);
  return left >= right ? BesideEdge{edge.left, left} : BesideEdge{edge.right, right};
}

double triangle_area(const ClippedPoint& p, const ClippedPoint& q, const ClippedPoint& r) {
  return 0.5 * (q.position - p.position).cross(r.position - p.position).norm();
}

}  // namespace

std::span<const ManifoldPoint> ContactManifold::points(const ShapePair& pair, const SeparatingAxis& axis, double alert,
                                                       int max_points) {
  candidates_.clear();
  const bool of_b = axis.feature.kind == AxisKind::face_of_b;
  if (axis.feature.kind == AxisKind::edges)
    edge_candidates(pair, axis, alert);
  else
    face_candidates(pair, axis, alert);
  reduce(max_points, pair.size());
  points_.clear();
  // candidates lie on the incident body's surface, which is a's for a reference face of b
  const double half = of_b ? 0.5 : -0.5;
  for (const ClippedPoint& p : candidates_) {
    const Vec3 in_a = of_b ? pair.other[0] * p.position : p.position;
    points_.push_back({p.key, in_a + half * p.height * axis.normal, p.height});
  }
  if (points_.size() > 1)
    std::sort(points_.begin(), points_.end(), [](const auto& p, const auto& q) { return p.key < q.key; });
  return points_;
}

/// The lines' closest points; those of bodies apart may lie beyond the edges' ends and are held there.
void ContactManifold::edge_candidates(const ShapePair& pair, const SeparatingAxis& axis, double alert) {
  constexpr double nearly_parallel = 0.99;  // cosine
  const CollisionShape &a = *pair.shape[0], &b = *pair.shape[1];
  const CollisionShape::Edge &edge_a = a.edges()[axis.feature.a], &edge_b = b.edges()[axis.feature.b];
  const Vec3 on_a = edge_a.from + std::clamp(axis.at_a, 0.0, 1.0) * edge_a.along;
  const Vec3 on_b = pair.other[0] * (edge_b.from + std::clamp(axis.at_b, 0.0, 1.0) * edge_b.along);
  ClippedPoint crossing;
  crossing.key = feature_key(PointKind::edges, axis.feature.a, axis.feature.b);
  crossing.height = axis.separation;
  crossing.position = 0.5 * (on_a + on_b) + 0.5 * axis.separation * axis.normal;
  crossing.next_edge = -1;

  const Vec3 normal_in_b = pair.other[1].rotation * axis.normal;
  const BesideEdge beside_a = most_aligned(edge_a, axis.normal), beside_b = most_aligned(edge_b, -normal_in_b);
  const int face_a = beside_a.face, face_b = beside_b.face;
  // An edge that lies nearly flat on a face touches at both ends of their overlap, not only where the axis happens to
  // see it this step: without the other end contact jumps from end to end as the body rocks by micrometres. An edge
  // along the face's own side has no second end on the face.
  const bool flat_on_a = beside_a.cosine > nearly_parallel;
  const bool flat_on_b = beside_b.cosine > nearly_parallel;
  const Vec3 along_b = pair.other[0].rotation * edge_b.along;
  const bool across =
      edge_a.along.cross(along_b).squaredNorm() > 0.01 * edge_a.along.squaredNorm() * along_b.squaredNorm();
  bool has_crossing = false;
  if ((flat_on_a && flat_on_b) || (across && (flat_on_a || flat_on_b))) {
    const int reference = flat_on_a ? 0 : 1;
    const std::span<const ClippedPoint> clipped =
        flat_on_a ? clipper_.clip_along(pair, 0, face_a, face_b, axis.normal, 1e-9 * pair.size())
                  : clipper_.clip_along(pair, 1, face_b, face_a, -normal_in_b, 1e-9 * pair.size());
    for (ClippedPoint p : clipped) {
      if (p.height > alert) continue;
      has_crossing |= p.key == crossing.key;
      if (reference == 1) p.position = pair.other[0] * p.position + p.height * axis.normal;  // from a's surface to b's
      candidates_.push_back(p.key == crossing.key ? crossing : p);
    }
  }
  if (!has_crossing) candidates_.push_back(crossing);
}

void ContactManifold::face_candidates(const ShapePair& pair, const SeparatingAxis& axis, double alert) {
  const int reference = axis.feature.kind == AxisKind::face_of_a ? 0 : 1;
  const int face = reference == 0 ? axis.feature.a : axis.feature.b;
  const double size = pair.size(), thickness = 1e-9 * size;
  const ClippedPoint touching = touching_vertex(pair, reference, face, axis.support);

  // Most contacts are one vertex on a face. All else of the other body rises from the vertex at `slope` at least, so
  // nothing within reach gets to the sides or to another vertex: what clipping would return is known.
  const double slope = axis.clearance / (2.0 * pair.shape[1 - reference]->circumradius());
  if (axis.inside > thickness && axis.separation + slope * axis.inside > alert + thickness &&
      axis.separation + axis.clearance > alert + thickness) {
    candidates_.push_back(touching);
    return;
  }
  double deepest = alert + size;
  const int incident = incident_face(pair, reference, face, axis.support);
  for (const ClippedPoint& point : clipper_.clip(pair, reference, face, incident, thickness)) {
    deepest = std::min(deepest, point.height);
    if (point.height <= alert) candidates_.push_back(point);
  }
  if (deepest > axis.separation + proof_margin(pair)) {
    std::erase_if(candidates_, [&](const ClippedPoint& point) { return point.key == touching.key; });
    candidates_.push_back(touching);
  }
}

/// Keeps the deepest point, then the one farthest from it, then again and again the one that adds most area to the
/// polygon of those kept. The candidates are corners of a convex polygon in order, so that the area added is that of
/// the triangle with the two neighbours kept. Near-ties go to the smallest key: rounding must not choose.
void ContactManifold::reduce(int max_points, double size) {
  const int count = static_cast<int>(candidates_.size());
  if (count <= max_points) return;
  by_key_.resize(count);
  for (int i = 0; i < count; ++i) by_key_[i] = i;
  std::sort(by_key_.begin(), by_key_.end(), [&](int i, int j) { return candidates_[i].key < candidates_[j].key; });
  chosen_.assign(count, 0);
  int deepest = by_key_[0];
  for (const int i : by_key_) {
    if (candidates_[i].height < candidates_[deepest].height - 1e-13 * size) deepest = i;
  }
  chosen_[deepest] = 1;
  const auto kept_beside = [&](int i, int step) {
    do i = (i + step + count) % count;
    while (!chosen_[i]);
    return i;
  };
  for (int kept = 1; kept < max_points; ++kept) {
    int best = -1;
    double best_gain = -1.0;
    for (const int i : by_key_) {
      if (chosen_[i]) continue;
      const ClippedPoint &before = candidates_[kept_beside(i, -1)], &after = candidates_[kept_beside(i, 1)];
      const double gain = kept == 1 ? (candidates_[i].position - before.position).norm() / size
                                    : triangle_area(before, candidates_[i], after) / (size * size);
      if (gain <= best_gain + 1e-9) continue;
      best_gain = gain;
      best = i;
    }
    chosen_[best] = 1;
  }
  int next = 0;
  for (int i = 0; i < count; ++i) {
    if (chosen_[i]) candidates_[next++] = candidates_[i];
  }
  candidates_.erase(candidates_.begin() + next, candidates_.end());
}

}  // namespace ballast
