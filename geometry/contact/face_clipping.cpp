#include "geometry/contact/face_clipping.hpp"

namespace ballast {

std::span<ClippedPoint> FaceClipper::clip(const ShapePair& pair, int reference, int face,
                                          int incident, double thickness) {
  const CollisionShape& shape = *pair.shape[reference];
  start(pair, reference, incident);
  const std::span<const CollisionShape::Side> sides = shape.sides(face);
  for (size_t k = 0; k < sides.size() && !polygon_.empty(); ++k)
    clip_by_side(pair, reference, face, static_cast<int>(k), {sides[k].outward, sides[k].offset},
                 thickness);
  return polygon_;
}

std::span<ClippedPoint> FaceClipper::clip_along(const ShapePair& pair, int reference, int face,
                                                int incident, const Vec3& direction,
                                                double thickness) {
  const CollisionShape& shape = *pair.shape[reference];
  start(pair, reference, incident);
  const std::span<const CollisionShape::Corner> corners = shape.corners(face);
  for (size_t k = 0; k < corners.size() && !polygon_.empty(); ++k) {
    const Vec3& from = corners[k].position;
    const Vec3 along = corners[k + 1 < corners.size() ? k + 1 : 0].position - from;
    const Vec3 outward = along.cross(direction).normalized();
    clip_by_side(pair, reference, face, static_cast<int>(k), {outward, outward.dot(from)},
                 thickness);
  }
  return polygon_;
}

void FaceClipper::start(const ShapePair& pair, int reference, int incident) {
  const CollisionShape& other = *pair.shape[1 - reference];
  polygon_.clear();
  for (const CollisionShape::Corner& corner : other.corners(incident)) {
    polygon_.push_back({pair.other[reference] * corner.position, 0.0,
                        vertex_key(1 - reference, corner.vertex), corner.edge});
  }
}

void FaceClipper::clip_by_side(const ShapePair& pair, int reference, int face, int k,
                               const Plane& plane, double thickness) {
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
    crossing.key = crossing_key(pair, reference, face, k, p.next_edge);
    crossing.next_edge = leaves ? ~k : p.next_edge;
    clipped_.push_back(crossing);
  }
  polygon_.swap(clipped_);
}

/// Side k of the reference face meets an edge of the incident face, or one of the face's own sides
/// at their common corner.
std::uint64_t FaceClipper::crossing_key(const ShapePair& pair, int reference, int face, int k,
                                        int edge) const {
  const std::span<const CollisionShape::Corner> corners = pair.shape[reference]->corners(face);
  const int own_edge = corners[k].edge;
  if (edge >= 0) return edges_key(reference, own_edge, edge);
  const int other_side = ~edge, count = static_cast<int>(corners.size());
  int corner = -1;
  if ((other_side + 1) % count == k) corner = corners[k].vertex;
  if ((k + 1) % count == other_side) corner = corners[other_side].vertex;
  if (corner < 0) return feature_key(PointKind::sides, own_edge, corners[other_side].edge);
  return vertex_key(reference, corner);
}

}  // namespace ballast
