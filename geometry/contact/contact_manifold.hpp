#pragma once
// A pair and its separating axis -> the points where the two bodies touch or may touch within the
// step.

#include <span>
#include <vector>

#include "geometry/contact/face_clipping.hpp"

namespace ballast {

struct ManifoldPoint {
  std::uint64_t key;  ///< unique within the pair
  Vec3 position;      ///< in a's frame, midway between the two surfaces [m]
  double gap;         ///< along the axis [m]; negative = overlap
};

// Most manifolds are one point whose place the axis alone tells; that point needs the features'
// records only.

/// The axis is a face and its support vertex is the manifold: all else of the other body rises out
/// of reach before it gets to the sides or to another vertex. With a lower bound of the clearance:
/// sufficient.
bool is_lone_vertex(const PairFrame& pair, const SeparatingAxis& axis, double alert);
/// `vertex`: the support, in its own frame.
ManifoldPoint lone_vertex(const PairFrame& pair, const SeparatingAxis& axis,
                          const CollisionShape::Face& face, const Vec3& vertex);

/// A face beside an edge, by its sides. `own`: which of them stands on that edge.
struct SidesBesideEdge {
  std::span<const CollisionShape::Side> sides;
  int own;
};
SidesBesideEdge sides_beside(const CollisionShape& shape, int face, int edge);

/// How two edges and the faces beside them lie.
struct EdgeCrossing {
  EdgeCrossing(const PairFrame& pair, const SeparatingAxis& axis, const CollisionShape::Edge& a,
               const CollisionShape::Edge& b);
  int face_a, face_b;         ///< beside the edges, that look along the axis most
  bool flat_on_a, flat_on_b;  ///< the other body lies nearly flat on them
  bool across;                ///< the edges are not nearly parallel
  double rise_a,
      rise_b;  ///< per unit length along each edge, how fast the other's face rises from it; no
               ///< less off the edges
  /// Neither body lies flat on the other: the lines' closest points are the manifold.
  bool is_sharp() const {
    return !(flat_on_a && flat_on_b) && !(across && (flat_on_a || flat_on_b));
  }
  /// Flat, but the other corners of the faces' common part are proved to be out of reach: the same.
  /// Sufficient.
  bool rises_out_of_reach(const PairFrame& pair, const SeparatingAxis& axis,
                          const CollisionShape::Edge& a, const CollisionShape::Edge& b,
                          const SidesBesideEdge& beside_a, const SidesBesideEdge& beside_b,
                          double alert) const;
};
/// The lines' closest points; those of bodies apart may lie beyond the edges' ends and are held
/// there.
ManifoldPoint crossing_point(const PairFrame& pair, const SeparatingAxis& axis,
                             const CollisionShape::Edge& a, const CollisionShape::Edge& b);

/// Holds scratch memory; one per thread.
class ContactManifold {
 public:
  /// Points of the pair with gap <= alert, at most `max_points` of them, sorted by key. The axis
  /// must be the pair's best and its separation <= alert. The smallest gap equals the separation:
  /// the touching vertex is added if clipping lost it. Face: the other body's face at its touching
  /// vertex that opposes the reference face most is clipped by the reference face's sides; each
  /// corner has its own gap. Edges: the lines' closest points; where faces beside the two edges are
  /// nearly parallel, the corners of their common part as well, so that a flat contact whose best
  /// axis happens to be an edge pair's keeps its points. Valid until the next call.
  std::span<const ManifoldPoint> points(const ShapePair& pair, const SeparatingAxis& axis,
                                        double alert, int max_points);

 private:
  void edge_candidates(const ShapePair& pair, const SeparatingAxis& axis, double alert);
  void face_candidates(const ShapePair& pair, const SeparatingAxis& axis, double alert);
  void reduce(int max_points, double size);

  FaceClipper clipper_;
  std::vector<ClippedPoint>
      candidates_;           // within reach, in the polygon's order; reference body's frame
  std::vector<int> by_key_;  // candidates in the order of their keys
  std::vector<char> chosen_;
  std::vector<ManifoldPoint> points_;
};

}  // namespace ballast
