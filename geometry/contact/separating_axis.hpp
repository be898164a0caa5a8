#pragma once
// Signed separation of two convex polyhedra along the facets of their Minkowski difference B - A.
//
// For a unit vector n let s(n) = min_B n.x - max_A n.x be the gap along n. The separation is the
// largest s over the facets of B - A, whose normals are A's face normals, B's face normals
// reversed, and cross products of an edge of A and an edge of B whose arcs on the Gauss sphere
// cross. For an overlapping pair it is minus the penetration depth, the largest s(n) of all n. For
// a pair apart it is positive; it is the distance if the nearest points lie inside the facet's two
// features.

#include <cmath>
#include <cstdint>
#include <optional>

#include "geometry/contact/collision_shape.hpp"

namespace ballast {

/// Pose of one body's frame in the other's: x = position + rotation * x_other.
struct RelativePose {
  Mat3 rotation;
  Vec3 position;
  Vec3 operator*(const Vec3& p) const { return position + rotation * p; }
  RelativePose inverse() const {
    return {rotation.transpose(), -(rotation.transpose() * position)};
  }
};

/// The relative pose and the sizes of two bodies; index 0 is a, 1 is b.
struct PairFrame {
  PairFrame(const BodyBounds& a, const BodyBounds& b, const RelativePose& b_in_a)
      : bounds{&a, &b}, other{b_in_a, b_in_a.inverse()}, size_(a.circumradius + b.circumradius) {
    // few pairs need the root
    const double apart = b_in_a.position.squaredNorm() / 256.0;
    if (apart > size_ * size_) size_ = std::sqrt(apart);
  }

  const BodyBounds* bounds[2];
  RelativePose other[2];  ///< other[i]: the other body's pose in the frame of body i
  /// The length that rounding errors and tolerances scale with [m]: the sum of the circumradii or,
  /// for bodies far apart, 1/16 of the distance that governs the rounding of their coordinates.
  double size() const { return size_; }

 private:
  double size_;
};

/// A PairFrame with the shapes' tables.
struct ShapePair : PairFrame {
  ShapePair(const CollisionShape& a, const CollisionShape& b, const RelativePose& b_in_a)
      : PairFrame(a.bounds(), b.bounds(), b_in_a), shape{&a, &b} {}
  const CollisionShape* shape[2];
};

enum class AxisKind : std::uint8_t { none, face_of_a, face_of_b, edges };

/// A facet of the Minkowski difference: a face of one body (the other index is -1) or an edge of
/// each.
struct AxisFeature {
  AxisKind kind = AxisKind::none;
  int a = -1, b = -1;

  static AxisFeature of_face(int body, int face) {
    return body == 0 ? AxisFeature{AxisKind::face_of_a, face, -1}
                     : AxisFeature{AxisKind::face_of_b, -1, face};
  }
  /// The body that the face belongs to, 0 = a; 0 for two edges.
  int reference() const { return kind == AxisKind::face_of_b ? 1 : 0; }
  int face() const { return reference() == 0 ? a : b; }
  bool operator==(const AxisFeature&) const = default;
};

/// The search's result: a facet, and the bodies' separation along it. The contact's normal, gaps
/// and points follow from it by the rule of contact_normal.hpp.
struct SeparatingAxis {
  AxisFeature feature;
  Vec3 direction = Vec3::Zero();  ///< unit, in a's frame, from a to b, across the facet
  double separation = 0.0;        ///< gap along the direction [m]; negative = overlap
  int support = -1;  ///< of a face: the other body's vertex nearest to its plane (smallest index
                     ///< among equals)
  /// Of two edges: the closest points of their lines, from the tails in edge lengths.
  double at_a = 0.0, at_b = 0.0;
  double inside = 0.0;  ///< how far inside the facet the origin projects [m]: of a face, where the
                        ///< support vertex projects; of two edges, where the lines' closest points
                        ///< lie; negative outside
  double clearance = 0.0;  ///< how much farther off than the touching vertex or edge all other
                           ///< vertices are [m]; of two edges a lower bound
};

/// Axes whose separations differ by less than this [m] count as equal, and a rule chooses: faces
/// before edges, a's before b's, the smaller index. Rounding errors are a hundred times smaller.
inline double tie_tolerance(const PairFrame& pair) { return 1e-13 * pair.size(); }
/// Margin of every proof that an axis is not the best [m]: above tie_tolerance by more than
/// rounding.
inline double proof_margin(const PairFrame& pair) { return 4e-13 * pair.size(); }

/// Edges with a smaller sine of the angle between them count as parallel: their cross product is
/// mostly rounding. The facet left out is a sliver of this width relative to the edge.
constexpr double parallel_sine = 1e-7;

/// Scratch: one double per padded vertex of the largest shape.
using Heights = std::vector<double>;

struct FaceSeparation {
  double separation;
  int support;
  double clearance;
};
/// Separation along face f of body `own`.
FaceSeparation face_separation(const ShapePair& pair, int own, int f, Heights& heights);

struct EdgeSeparation {
  double separation = 0.0;
  Vec3 direction;  ///< unit, in a's frame, from a to b
  Vec3 along_b;    ///< b's edge in a's frame
  double cross;    ///< along_a x along_b = cross * direction
  bool nearly_parallel = false;
  /// For CollisionShape::Edge::drop: the smaller |normal of a face beside the edge . other edge|.
  double weight_a, weight_b;
};
/// Separation along the facet of edges ea of a and eb of b; empty if they form no facet or count as
/// parallel.
std::optional<EdgeSeparation> edge_separation(const ShapePair& pair, int ea, int eb,
                                              Heights& heights);

/// The axis of one feature. Empty if the feature is none or no facet at this pose. It depends on
/// the pair and the feature alone.
std::optional<SeparatingAxis> evaluate_axis(const ShapePair& pair, const AxisFeature& feature,
                                            Heights& heights);

/// Smallest angle between the feature's face and any other of its body [rad]; 1 for two edges.
double face_isolation(const ShapePair& pair, const AxisFeature& feature);

/// True if it is proved that every other facet's separation is smaller by more than proof_margin.
/// The proof is sufficient, not necessary: it fails for near-ties and for axes whose `inside` is
/// not well above zero. The axis' clearance may be a lower bound.
bool is_proved_best(const PairFrame& pair, double face_isolation, const SeparatingAxis& axis);

// The same axes, to the same bits, from the records of the features alone. The memory of a touching
// pair (touching_pair.hpp) holds these records and nothing else of the shapes.

/// The facet of two edges, or nothing. For nearly parallel edges direction and separation are not
/// set: they need the shapes' tables (edge_separation).
std::optional<EdgeSeparation> edge_facet(const PairFrame& pair, const CollisionShape::Edge& a,
                                         const CollisionShape::Edge& b);
SeparatingAxis edge_axis(const PairFrame& pair, const AxisFeature& feature,
                         const CollisionShape::Edge& a, const CollisionShape::Edge& b,
                         const EdgeSeparation& found);

/// The separation along a face of body `own`. `height`: vertex_height of the other body's lowest
/// vertex along the face's normal.
inline double face_separation_at(const PairFrame& pair, int own, const CollisionShape::Face& face,
                                 double height) {
  return height + (face.normal.dot(pair.other[own].position) - face.offset);
}
/// The axis of a face, without support and clearance. `side_at`: side k of the face, of `sides`.
/// `vertex`: the other body's lowest vertex over the face, in its own frame.
template <class SideAt>
SeparatingAxis face_axis(const PairFrame& pair, const AxisFeature& feature,
                         const CollisionShape::Face& face, int sides, const SideAt& side_at,
                         const Vec3& vertex, double separation) {
  const int own = feature.reference();
  SeparatingAxis axis;
  axis.feature = feature;
  axis.separation = separation;
  axis.direction = own == 0 ? face.normal : Vec3(-(pair.other[0].rotation * face.normal));
  const Vec3 support = pair.other[own] * vertex;
  axis.inside = pair.size();
  for (int k = 0; k < sides; ++k) {
    const CollisionShape::Side& side = side_at(k);
    axis.inside = std::min(axis.inside, side.offset - side.outward.dot(support));
  }
  return axis;
}

}  // namespace ballast
