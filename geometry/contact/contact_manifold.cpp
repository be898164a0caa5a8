#include "geometry/contact/contact_manifold.hpp"

#include <algorithm>
#include <cmath>

namespace ballast {
namespace {

double triangle_area(const ClippedPoint& p, const ClippedPoint& q, const ClippedPoint& r) {
  return 0.5 * (q.position - p.position).cross(r.position - p.position).norm();
}

/// The key of the point where side k of the reference face meets an edge of the incident face, or
/// another side of the reference face at their common corner.
std::uint64_t crossing_key(int reference, std::span<const CollisionShape::Corner> corners, int k,
                           int edge) {
  const int own_edge = corners[k].edge;
  if (edge >= 0)
    return reference == 0 ? feature_key(PointKind::edges, own_edge, edge)
                          : feature_key(PointKind::edges, edge, own_edge);
  const int other_side = ~edge, count = static_cast<int>(corners.size());
  int corner = -1;
  if ((other_side + 1) % count == k) corner = corners[k].vertex;
  if ((k + 1) % count == other_side) corner = corners[other_side].vertex;
  if (corner < 0) return feature_key(PointKind::sides, own_edge, corners[other_side].edge);
  return vertex_key(reference, corner);
}

/// Side k of the prism on a face, along its normal or along `direction`.
[[gnu::always_inline]] inline CollisionShape::Side prism_side(const CollisionShape::FaceView& face,
                                                              size_t k, const Vec3* direction) {
  if (!direction) return face.sides[k];
  const Vec3& from = face.corners[k].position;
  const Vec3 along = face.corners[k + 1 < face.corners.size() ? k + 1 : 0].position - from;
  const Vec3 outward = along.cross(*direction).normalized();
  return {outward, outward.dot(from)};
}

bool may_be_joint(const SeparatingAxis& axis, const ManifoldLimits& limits) {
  return limits.is_passing || std::abs(axis.separation) <= limits.joint;
}

/// True if, at one side of the prism, the incident face reaches inwards by at most limits.joint.
bool is_joint(const PairFrame& pair, const SeparatingAxis& axis, const ManifoldLimits& limits,
              int reference, const CollisionShape::FaceView& face,
              std::span<const CollisionShape::Corner> incident, const Vec3* direction = nullptr) {
  if (!may_be_joint(axis, limits)) return false;
  for (size_t k = 0; k < face.corners.size(); ++k) {
    const CollisionShape::Side side = prism_side(face, k, direction);
    if (std::ranges::all_of(incident, [&](const CollisionShape::Corner& corner) {
          const Vec3 place = pair.other[reference] * corner.position;
          return side.outward.dot(place) - side.offset >= -limits.joint;
        }))
      return true;
  }
  return false;
}

/// True if one of the two edges ends within limits.joint of the crossing, or before it.
bool is_joint(const SeparatingAxis& axis, const ManifoldLimits& limits,
              const CollisionShape::Edge& a, const CollisionShape::Edge& b) {
  const auto ends = [&](double at, double length) {
    return std::min(at, 1.0 - at) * length <= limits.joint;
  };
  return may_be_joint(axis, limits) && (ends(axis.at_a, a.length) || ends(axis.at_b, b.length));
}

}  // namespace

std::span<ClippedPoint> FaceClipper::clip(const PairFrame& pair, int reference,
                                          const FaceView& face,
                                          std::span<const CollisionShape::Corner> incident,
                                          const Vec3* direction) {
  polygon_.clear();
  for (const CollisionShape::Corner& corner : incident)
    polygon_.push_back({pair.other[reference] * corner.position, 0.0,
                        vertex_key(1 - reference, corner.vertex), corner.edge});
  const double thickness = clipping_thickness(pair.size());
  for (size_t k = 0; k < face.corners.size() && !polygon_.empty(); ++k)
    clip_by_side(reference, face, static_cast<int>(k), prism_side(face, k, direction), thickness);
  return polygon_;
}

void FaceClipper::clip_by_side(int reference, const FaceView& face, int k,
                               const CollisionShape::Side& side, double thickness) {
  distance_.clear();
  bool all_inside = true;
  for (const ClippedPoint& p : polygon_) {
    distance_.push_back(side.outward.dot(p.position) - side.offset);
    all_inside &= distance_.back() <= thickness;
  }
  if (all_inside) return;
  clipped_.clear();
  for (size_t i = 0; i < polygon_.size(); ++i) {
    const size_t next = i + 1 < polygon_.size() ? i + 1 : 0;
    const ClippedPoint& p = polygon_[i];
    const double here = distance_[i], there = distance_[next];
    if (here <= thickness) {
      clipped_.push_back(p);
      // This corner is in the side's plane and its edge leaves: the polygon goes on along the side.
      if (here >= -thickness && there > thickness) clipped_.back().next_edge = ~k;
    }
    const bool leaves = here < -thickness && there > thickness,
               enters = here > thickness && there < -thickness;
    if (!leaves && !enters) continue;
    clipped_.push_back(
        {p.position + (polygon_[next].position - p.position) * (here / (here - there)), 0.0,
         crossing_key(reference, face.corners, k, p.next_edge), leaves ? ~k : p.next_edge});
  }
  polygon_.swap(clipped_);
}

/// All other vertices are at least `clearance` higher and at most a diameter away from the support
/// vertex, so that the body rises from it with at least the slope clearance / diameter.
bool is_lone_vertex(const PairFrame& pair, const SeparatingAxis& axis,
                    const ManifoldLimits& limits) {
  const double alert = limits.alert;
  if (axis.inside <= limits.joint) return false;  // it may be a joint
  const double thickness = clipping_thickness(pair.size());
  const double diameter = 2.0 * pair.bounds[1 - axis.feature.reference()]->circumradius;
  const double slope = axis.clearance / diameter;
  // At the nearest side of the face, `inside` away, the body is at least slope times inside higher
  // than its support vertex: the part cut off is out of reach, and so is every other vertex.
  return axis.inside > thickness && axis.separation + slope * axis.inside > alert + thickness &&
         axis.separation + axis.clearance > alert + thickness;
}

int incident_face(const ShapePair& pair, int reference, int face, int vertex) {
  const CollisionShape& other = *pair.shape[1 - reference];
  const Vec3 direction =
      pair.other[1 - reference].rotation * pair.shape[reference]->face(face).normal;
  int incident = -1;
  double most_opposed = 2.0;
  for (int k = 0; k < other.vertex_face_count(vertex); ++k) {
    const int f = other.vertex_face(vertex, k);
    const double cosine = other.face(f).normal.dot(direction);
    if (cosine >= most_opposed - equal_cosines) continue;
    most_opposed = cosine;
    incident = f;
  }
  return incident;
}

std::span<const ManifoldPoint> ContactManifold::points(const ShapePair& pair,
                                                       const SeparatingAxis& axis,
                                                       const ManifoldLimits& limits) {
  const AxisFeature& feature = axis.feature;
  if (feature.kind == AxisKind::edges) {
    const CollisionShape::Edge a = pair.shape[0]->edge(feature.a),
                               b = pair.shape[1]->edge(feature.b);
    const EdgesMeeting meeting(pair, axis, a, b);
    if (meeting.is_sharp()) return crossing(pair, axis, a, b, limits);
    pair.shape[0]->write(meeting.face_a, face_of_[0]);
    pair.shape[1]->write(meeting.face_b, face_of_[1]);
    return points(pair, axis, meeting, {a, b, face_of_[0].view(), face_of_[1].view()}, limits);
  }
  const int reference = feature.reference(), face = feature.face();
  const CollisionShape &own = *pair.shape[reference], &other = *pair.shape[1 - reference];
  const Vec3 vertex = other.vertices().xyz(axis.support);
  if (is_lone_vertex(pair, axis, limits))
    return lone_point(pair, axis, vertex_on_face(pair, axis, own.face(face), vertex));
  own.write(face, face_of_[reference]);
  other.write(incident_face(pair, reference, face, axis.support), face_of_[1 - reference]);
  return points(pair, axis, {face_of_[reference].view(), face_of_[1 - reference].corners, vertex},
                limits);
}

std::span<const ManifoldPoint> ContactManifold::lone_point(const PairFrame& pair,
                                                           const SeparatingAxis& axis,
                                                           const ClippedPoint& place) {
  points_.assign(1, contact_at(pair, axis, place));
  return points_;
}

std::span<const ManifoldPoint> ContactManifold::crossing(const PairFrame& pair,
                                                         const SeparatingAxis& axis,
                                                         const CollisionShape::Edge& a,
                                                         const CollisionShape::Edge& b,
                                                         const ManifoldLimits& limits) {
  if (is_joint(axis, limits, a, b)) return {};
  return lone_point(pair, axis, edges_cross(pair, axis, a, b));
}

/// Reduces the candidates to `max_points` and returns their points in the order of their keys.
std::span<const ManifoldPoint> ContactManifold::chosen_points(const PairFrame& pair,
                                                              const SeparatingAxis& axis,
                                                              int max_points) {
  reduce(max_points, pair.size());
  points_.clear();
  for (const ClippedPoint& p : candidates_) points_.push_back(contact_at(pair, axis, p));
  if (points_.size() > 1) std::ranges::sort(points_, {}, &ManifoldPoint::key);
  return points_;
}

/// Collects the corners of the faces' common part, cut along the axis, and the edges' crossing.
std::span<const ManifoldPoint> ContactManifold::points(const PairFrame& pair,
                                                       const SeparatingAxis& axis,
                                                       const EdgesMeeting& meeting,
                                                       const EdgeOnEdge& edges,
                                                       const ManifoldLimits& limits) {
  candidates_.clear();
  const ClippedPoint crossing = edges_cross(pair, axis, edges.a, edges.b);
  const int reference = meeting.reference();
  const CollisionShape::FaceView &face = reference == 0 ? edges.beside_a : edges.beside_b,
                                 &incident = reference == 0 ? edges.beside_b : edges.beside_a;
  const Vec3 direction =
      reference == 0 ? axis.direction : Vec3(-(pair.other[1].rotation * axis.direction));
  if (is_joint(pair, axis, limits, reference, face, incident.corners, &direction)) return {};
  const std::span<ClippedPoint> corners =
      clipper_.clip(pair, reference, face, incident.corners, &direction);
  set_heights(corners, face.face, &direction);
  bool has_crossing = false;
  for (ClippedPoint p : corners) {
    if (p.height > limits.alert) continue;
    has_crossing |= p.key == crossing.key;
    // the corners of a's face are on a's surface: moves them to b's, in a's frame
    if (reference == 1) p.position = pair.other[0] * p.position + p.height * axis.direction;
    candidates_.push_back(p.key == crossing.key ? crossing : p);
  }
  if (!has_crossing) candidates_.push_back(crossing);
  return chosen_points(pair, axis, limits.max_points);
}

std::span<const ManifoldPoint> ContactManifold::points(const PairFrame& pair,
                                                       const SeparatingAxis& axis,
                                                       const FaceOnFace& faces,
                                                       const ManifoldLimits& limits) {
  if (is_joint(pair, axis, limits, axis.feature.reference(), faces.reference, faces.incident))
    return {};
  candidates_.clear();
  const CollisionShape::Face& face = faces.reference.face;
  const ClippedPoint touching = vertex_on_face(pair, axis, face, faces.vertex);
  const std::span<ClippedPoint> corners =
      clipper_.clip(pair, axis.feature.reference(), faces.reference, faces.incident);
  set_heights(corners, face);
  double deepest = limits.alert + pair.size();
  for (const ClippedPoint& point : corners) {
    deepest = std::min(deepest, point.height);
    if (point.height <= limits.alert) candidates_.push_back(point);
  }
  // If no corner is as deep as the touching vertex, that vertex was cut off beside the face.
  if (!limits.is_passing && deepest > touching.height + proof_margin(pair)) {
    std::erase_if(candidates_,
                  [&](const ClippedPoint& point) { return point.key == touching.key; });
    candidates_.push_back(touching);
  }
  return chosen_points(pair, axis, limits.max_points);
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
  std::ranges::sort(by_key_, {}, [&](int i) { return candidates_[i].key; });
  chosen_.assign(count, 0);
  int deepest = by_key_[0];
  for (const int i : by_key_)
    if (candidates_[i].height < candidates_[deepest].height - 1e-13 * size) deepest = i;
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
  for (int i = 0; i < count; ++i)
    if (chosen_[i]) candidates_[next++] = candidates_[i];
  candidates_.erase(candidates_.begin() + next, candidates_.end());
}

}  // namespace ballast
