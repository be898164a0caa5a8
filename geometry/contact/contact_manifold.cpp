#include "geometry/contact/contact_manifold.hpp"

#include <algorithm>
#include <cmath>

namespace ballast {
namespace {

/// The face of the other body, among those at its touching vertex, that opposes the reference face
/// most. Near-ties go to the smallest index: rounding must not choose.
int incident_face(const ShapePair& pair, int reference, int face, int vertex) {
  const CollisionShape& other = *pair.shape[1 - reference];
  const Vec3 direction =
      pair.other[1 - reference].rotation * pair.shape[reference]->face(face).normal;
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

/// `vertex` of the body beside the reference's, in its own frame.
ClippedPoint touching_vertex(const PairFrame& pair, int reference,
                             const CollisionShape::Face& plane, int index, const Vec3& vertex) {
  ClippedPoint point;
  point.position = pair.other[reference] * vertex;
  point.height = plane.normal.dot(point.position) - plane.offset;
  point.key = reference == 0 ? feature_key(PointKind::vertex_of_b, 0, index)
                             : feature_key(PointKind::vertex_of_a, index, 0);
  point.next_edge = -1;
  return point;
}

ClippedPoint edges_meet(const PairFrame& pair, const SeparatingAxis& axis,
                        const CollisionShape::Edge& edge_a, const CollisionShape::Edge& edge_b) {
  const Vec3 on_a = edge_a.from + std::clamp(axis.at_a, 0.0, 1.0) * edge_a.along;
  const Vec3 on_b = pair.other[0] * (edge_b.from + std::clamp(axis.at_b, 0.0, 1.0) * edge_b.along);
  ClippedPoint crossing;
  crossing.key = feature_key(PointKind::edges, axis.feature.a, axis.feature.b);
  crossing.height = axis.separation;
  crossing.position = 0.5 * (on_a + on_b) + 0.5 * axis.separation * axis.normal;
  crossing.next_edge = -1;
  return crossing;
}

int reference_of(const SeparatingAxis& axis) {
  return axis.feature.kind == AxisKind::face_of_b ? 1 : 0;
}

/// Corners lie on the incident body's surface, in the reference body's frame: that is a's surface
/// for a reference face of b.
ManifoldPoint midway(const PairFrame& pair, const SeparatingAxis& axis, const ClippedPoint& p) {
  const bool of_b = reference_of(axis) == 1;
  const double half = of_b ? 0.5 : -0.5;
  const Vec3 in_a = of_b ? pair.other[0] * p.position : p.position;
  return {p.key, in_a + half * p.height * axis.normal, p.height};
}

constexpr double thickness_of(double size) { return 1e-9 * size; }

/// The face beside an edge that looks along d most. The edge's record knows both normals: the
/// faces' are left alone.
struct BesideEdge {
  int face;
  Vec3 normal;
  double cosine;
};
BesideEdge most_aligned(const CollisionShape::Edge& edge, const Vec3& d) {
  const double left = edge.left_normal.dot(d), right = edge.right_normal.dot(d);
  return left >= right ? BesideEdge{edge.left, edge.left_normal, left}
                       : BesideEdge{edge.right, edge.right_normal, right};
}

double triangle_area(const ClippedPoint& p, const ClippedPoint& q, const ClippedPoint& r) {
  return 0.5 * (q.position - p.position).cross(r.position - p.position).norm();
}

}  // namespace

/// All else of the other body rises from the vertex at `slope` at least.
bool is_lone_vertex(const PairFrame& pair, const SeparatingAxis& axis, double alert) {
  const double thickness = thickness_of(pair.size());
  const double slope = axis.clearance / (2.0 * pair.bounds[1 - reference_of(axis)]->circumradius);
  return axis.inside > thickness && axis.separation + slope * axis.inside > alert + thickness &&
         axis.separation + axis.clearance > alert + thickness;
}

ManifoldPoint lone_vertex(const PairFrame& pair, const SeparatingAxis& axis,
                          const CollisionShape::Face& face, const Vec3& vertex) {
  return midway(pair, axis, touching_vertex(pair, reference_of(axis), face, axis.support, vertex));
}

// An edge that lies nearly flat on a face touches at both ends of their overlap, not only where the
// axis happens to see it this step: without the other end contact jumps from end to end as the body
// rocks by micrometres. An edge along the face's own side has no second end on the face.
EdgeCrossing::EdgeCrossing(const PairFrame& pair, const SeparatingAxis& axis,
                           const CollisionShape::Edge& a, const CollisionShape::Edge& b) {
  constexpr double nearly_parallel = 0.99;  // cosine
  const BesideEdge beside_a = most_aligned(a, axis.normal);
  const Vec3 towards_a = -(pair.other[1].rotation * axis.normal);
  const BesideEdge beside_b = most_aligned(b, towards_a);
  face_a = beside_a.face;
  face_b = beside_b.face;
  flat_on_a = beside_a.cosine > nearly_parallel;
  flat_on_b = beside_b.cosine > nearly_parallel;
  const Vec3 along_b = pair.other[0].rotation * b.along;
  across =
      a.along.cross(along_b).squaredNorm() > 0.01 * a.along.squaredNorm() * along_b.squaredNorm();
  const Vec3 along_a = pair.other[1].rotation * a.along;
  rise_a = std::abs(beside_b.normal.dot(along_a)) / (a.length * beside_b.cosine);
  rise_b = std::abs(beside_a.normal.dot(along_b)) / (b.length * beside_a.cosine);
}

SidesBesideEdge sides_beside(const CollisionShape& shape, int face, int edge) {
  const std::span<const CollisionShape::Corner> corners = shape.corners(face);
  int own = 0;
  while (corners[own].edge != edge) ++own;
  return {shape.sides(face), own};
}

/// Over the faces' common part the height between them is linear, least at the crossing x0, and its
/// corner there lies between the directions of the two edges (each tilted along the axis into the
/// incident plane, which stretches it by sqrt(1 + rise^2)). Nearer than `room` to x0 no other side
/// cuts, so that all other corners are at least that far, and `room` times the lesser slope higher.
/// Of the reference face, sides stand along the axis instead of its normal: cos
/// >= 0.99.
bool EdgeCrossing::rises_out_of_reach(const PairFrame& pair, const SeparatingAxis& axis,
                                      const CollisionShape::Edge& a, const CollisionShape::Edge& b,
                                      const SidesBesideEdge& beside_a,
                                      const SidesBesideEdge& beside_b, double alert) const {
  const double thickness = thickness_of(pair.size());
  if (!across || !(axis.inside > thickness)) return false;
  double room = pair.size();
  const auto narrow = [&](const SidesBesideEdge& beside, const Vec3& at) {
    for (size_t k = 0; k < beside.sides.size(); ++k) {
      const CollisionShape::Side& side = beside.sides[k];
      if (static_cast<int>(k) != beside.own)
        room = std::min(room, side.offset - side.outward.dot(at));
    }
  };
  narrow(beside_a, a.from + axis.at_a * a.along);
  narrow(beside_b, b.from + axis.at_b * b.along);
  const double slope = std::min(rise_a / std::sqrt(1.0 + rise_a * rise_a),
                                rise_b / std::sqrt(1.0 + rise_b * rise_b));
  return room > 4.0 * thickness && axis.separation + 0.98 * room * slope > alert + 4.0 * thickness;
}

ManifoldPoint crossing_point(const PairFrame& pair, const SeparatingAxis& axis,
                             const CollisionShape::Edge& a, const CollisionShape::Edge& b) {
  return midway(pair, axis, edges_meet(pair, axis, a, b));
}

std::span<const ManifoldPoint> ContactManifold::points(const ShapePair& pair,
                                                       const SeparatingAxis& axis, double alert,
                                                       int max_points) {
  candidates_.clear();
  if (axis.feature.kind == AxisKind::edges)
    edge_candidates(pair, axis, alert);
  else
    face_candidates(pair, axis, alert);
  reduce(max_points, pair.size());
  points_.clear();
  for (const ClippedPoint& p : candidates_) points_.push_back(midway(pair, axis, p));
  if (points_.size() > 1)
    std::sort(points_.begin(), points_.end(),
              [](const auto& p, const auto& q) { return p.key < q.key; });
  return points_;
}

void ContactManifold::edge_candidates(const ShapePair& pair, const SeparatingAxis& axis,
                                      double alert) {
  const CollisionShape::Edge& edge_a = pair.shape[0]->edges()[axis.feature.a];
  const CollisionShape::Edge& edge_b = pair.shape[1]->edges()[axis.feature.b];
  const ClippedPoint crossing = edges_meet(pair, axis, edge_a, edge_b);
  const EdgeCrossing edges(pair, axis, edge_a, edge_b);
  bool has_crossing = false;
  if (!edges.is_sharp() &&
      !edges.rises_out_of_reach(
          pair, axis, edge_a, edge_b, sides_beside(*pair.shape[0], edges.face_a, axis.feature.a),
          sides_beside(*pair.shape[1], edges.face_b, axis.feature.b), alert)) {
    const int reference = edges.flat_on_a ? 0 : 1;
    const Vec3 direction =
        reference == 0 ? axis.normal : Vec3(-(pair.other[1].rotation * axis.normal));
    const int face = reference == 0 ? edges.face_a : edges.face_b,
              incident = reference == 0 ? edges.face_b : edges.face_a;
    for (ClippedPoint p : clipper_.clip_along(pair, reference, face, incident, direction,
                                              thickness_of(pair.size()))) {
      if (p.height > alert) continue;
      has_crossing |= p.key == crossing.key;
      if (reference == 1)
        p.position =
            pair.other[0] * p.position + p.height * axis.normal;  // from a's surface to b's
      candidates_.push_back(p.key == crossing.key ? crossing : p);
    }
  }
  if (!has_crossing) candidates_.push_back(crossing);
}

void ContactManifold::face_candidates(const ShapePair& pair, const SeparatingAxis& axis,
                                      double alert) {
  const int reference = reference_of(axis);
  const int face = reference == 0 ? axis.feature.a : axis.feature.b;
  const double size = pair.size();
  const ClippedPoint touching =
      touching_vertex(pair, reference, pair.shape[reference]->face(face), axis.support,
                      pair.shape[1 - reference]->vertices().xyz(axis.support));
  if (is_lone_vertex(pair, axis, alert)) {  // what clipping would return is known
    candidates_.push_back(touching);
    return;
  }
  double deepest = alert + size;
  const int incident = incident_face(pair, reference, face, axis.support);
  for (const ClippedPoint& point :
       clipper_.clip(pair, reference, face, incident, thickness_of(size))) {
    deepest = std::min(deepest, point.height);
    if (point.height <= alert) candidates_.push_back(point);
  }
  if (deepest > axis.separation + proof_margin(pair)) {
    std::erase_if(candidates_,
                  [&](const ClippedPoint& point) { return point.key == touching.key; });
    candidates_.push_back(touching);
  }
}

/// Keeps the deepest point, then the one farthest from it, then again and again the one that adds
/// most area to the polygon of those kept. The candidates are corners of a convex polygon in order,
/// so that the area added is that of the triangle with the two neighbours kept. Near-ties go to the
/// smallest key: rounding must not choose.
void ContactManifold::reduce(int max_points, double size) {
  const int count = static_cast<int>(candidates_.size());
  if (count <= max_points) return;
  by_key_.resize(count);
  for (int i = 0; i < count; ++i) by_key_[i] = i;
  std::sort(by_key_.begin(), by_key_.end(),
            [&](int i, int j) { return candidates_[i].key < candidates_[j].key; });
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
      const ClippedPoint &before = candidates_[kept_beside(i, -1)],
                         &after = candidates_[kept_beside(i, 1)];
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
