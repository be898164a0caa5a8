#include "geometry/contact/contact_normal.hpp"

#include <algorithm>

namespace ballast {
namespace {

/// Of the two faces beside an edge, the one whose normal is nearest to d. The edge's record holds
/// both normals, so that the faces' records need not be read.
struct FaceBesideEdge {
  int face;
  double cosine;
};
FaceBesideEdge most_aligned(const CollisionShape::Edge& edge, const Vec3& d) {
  const double left = edge.left_normal.dot(d), right = edge.right_normal.dot(d);
  return left >= right ? FaceBesideEdge{edge.left, left} : FaceBesideEdge{edge.right, right};
}

}  // namespace

ManifoldPoint contact_at(const PairFrame& pair, const SeparatingAxis& axis,
                         const ClippedPoint& place) {
  const Vec3 normal = contact_normal(pair, axis);
  const double gap = contact_gap(pair, axis, place.height);
  if (axis.feature.reference() == 1)
    return {place.key, midway_from_a(pair.other[0] * place.position, gap, normal), gap};
  return {place.key, midway_from_b(place.position, gap, normal), gap};
}

ClippedPoint vertex_on_face(const PairFrame& pair, const SeparatingAxis& axis,
                            const CollisionShape::Face& face, const Vec3& vertex) {
  const int reference = axis.feature.reference();
  const Vec3 position = pair.other[reference] * vertex;
  return {position, height_over_face(face, position), vertex_key(1 - reference, axis.support), -1};
}

ClippedPoint edges_cross(const PairFrame& pair, const SeparatingAxis& axis,
                         const CollisionShape::Edge& a, const CollisionShape::Edge& b) {
  // The closest points of the lines, held within the edges; s is negative where the bodies overlap:
  //
  //     ----- x_b -----   b's edge, at_b of its length from the tail
  //            |          s along d
  //     ----- x_a -----   a's edge, at_a of its length from the tail
  const Vec3 on_a = a.from + std::clamp(axis.at_a, 0.0, 1.0) * a.along;
  const Vec3 on_b = pair.other[0] * (b.from + std::clamp(axis.at_b, 0.0, 1.0) * b.along);
  // b's surface is half the height from the middle, unless the points are held at the ends.
  const double height = axis.separation;
  return {0.5 * (on_a + on_b) + 0.5 * height * axis.direction, height,
          feature_key(PointKind::edges, axis.feature.a, axis.feature.b), -1};
}

EdgesMeeting::EdgesMeeting(const PairFrame& pair, const SeparatingAxis& axis,
                           const CollisionShape::Edge& a, const CollisionShape::Edge& b) {
  constexpr double flat = 0.99;            // cosine of 8 degrees
  constexpr double across_squared = 0.01;  // squared sine of 6 degrees
  const FaceBesideEdge beside_a = most_aligned(a, axis.direction);
  const Vec3 towards_a = -(pair.other[1].rotation * axis.direction);  // b's frame
  const FaceBesideEdge beside_b = most_aligned(b, towards_a);
  face_a = beside_a.face;
  face_b = beside_b.face;
  flat_on_a = beside_a.cosine > flat;
  flat_on_b = beside_b.cosine > flat;
  const Vec3 along_b = pair.other[0].rotation * b.along;
  // |a x b| = |a| |b| sin, squared so that no root is needed.
  across = a.along.cross(along_b).squaredNorm() >
           across_squared * a.along.squaredNorm() * along_b.squaredNorm();
}

}  // namespace ballast
