#include "geometry/contact/face_clipping.hpp"

namespace ballast {
namespace {

/// Side k of the reference face meets an edge of the incident face, or one of the face's own sides
/// at their common corner.
std::uint64_t crossing_key(int reference, std::span<const CollisionShape::Corner> corners, int k,
                           int edge) {
  const int own_edge = corners[k].edge;
  if (edge >= 0) return edges_key(reference, own_edge, edge);
  const int other_side = ~edge, count = static_cast<int>(corners.size());
  int corner = -1;
  if ((other_side + 1) % count == k) corner = corners[k].vertex;
  if ((k + 1) % count == other_side) corner = corners[other_side].vertex;
  if (corner < 0) return feature_key(PointKind::sides, own_edge, corners[other_side].edge);
  return vertex_key(reference, corner);
}

}  // namespace

std::span<ClippedPoint> FaceClipper::clip(const PairFrame& pair, int reference,
                                          const FaceView& face, const FaceView& incident,
                                          double thickness) {
  start(pair, reference, incident);
  for (size_t k = 0; k < face.sides.size() && !polygon_.empty(); ++k)
    clip_by_side(reference, face, static_cast<int>(k),
                 {face.sides[k].outward, face.sides[k].offset}, thickness);
  return polygon_;
}

std::span<ClippedPoint> FaceClipper::clip_along(const PairFrame& pair, int reference,
                                                const FaceView& face, const FaceView& incident,
                                                const Vec3& direction, double thickness) {
  start(pair, reference, incident);
  const std::span<const CollisionShape::Corner> corners = face.corners;
  for (size_t k = 0; k < corners.size() && !polygon_.empty(); ++k) {
    const Vec3& from = corners[k].position;
    const Vec3 along = corners[k + 1 < corners.size() ? k + 1 : 0].position - from;
    const Vec3 outward = along.cross(direction).normalized();
    clip_by_side(reference, face, static_cast<int>(k), {outward, outward.dot(from)}, thickness);
  }
  return polygon_;
}

void FaceClipper::start(const PairFrame& pair, int reference, const FaceView& incident) {
  polygon_.clear();
  for (const CollisionShape::Corner& corner : incident.corners)
    polygon_.push_back({pair.other[reference] * corner.position, 0.0,
                        vertex_key(1 - reference, corner.vertex), corner.edge});
}

void FaceClipper::clip_by_side(int reference, const FaceView& face, int k, const Plane& plane,
                               double thickness) {
  distance_.clear();
  bool all_inside = true;
  for (const ClippedPoint& p : polygon_) {
    distance_.push_back(plane.outward.dot(p.position) - plane.offset);
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
      // A corner in the plane whose edge leaves: the polygon goes on along the side.
      if (here >= -thickness && there > thickness) clipped_.back().next_edge = ~k;
    }
    const bool leaves = here < -thickness && there > thickness,
               enters = here > thickness && there < -thickness;
    if (!leaves && !enters) continue;
    ClippedPoint crossing;
    crossing.position =
        p.position + (polygon_[next].position - p.position) * (here / (here - there));
    crossing.height = 0.0;
    crossing.key = crossing_key(reference, face.corners, k, p.next_edge);
    crossing.next_edge = leaves ? ~k : p.next_edge;
    clipped_.push_back(crossing);
  }
  polygon_.swap(clipped_);
}

}  // namespace ballast
