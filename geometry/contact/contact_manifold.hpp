#pragma once
// A pair and its separating axis -> the points where the two bodies touch or may touch within the
// step. The contact rule (contact_normal.hpp) says which points these are; this module collects
// them and, where there are too many, keeps the most useful ones.

#include <span>
#include <vector>

#include "geometry/contact/contact_normal.hpp"

namespace ballast {

/// Returns the face of body 1 - `reference`, among those at `vertex`, that opposes the reference
/// face most. Near-ties go to the smallest index: rounding must not choose.
int incident_face(const ShapePair& pair, int reference, int face, int vertex);
/// Cosines nearer than this are near-ties.
constexpr double equal_cosines = 1e-12;

/// Limits on the points of a pair.
struct ManifoldLimits {
  double alert;    ///< the largest gap of a point [m]
  int max_points;  ///< of a pair; the deepest is always kept
  /// For joints of bodies that do not move freely [m]: a face (or edge) that ends within this of
  /// the other one's side (or end), or before it, only lies beside it. Such a pair has no points
  /// while gap and overlap are not larger than this. Below 0: there are no joints.
  double joint = -1.0;
  bool is_passing = false;  ///< faces and edges that only lie beside have no points at any gap
};

/// The input of a manifold whose axis is a face: that face, the corners of the incident face, and
/// the axis' support vertex, each in its own body's frame. Of the reference face's corners only the
/// indices are read.
struct FaceOnFace {
  CollisionShape::FaceView reference;
  std::span<const CollisionShape::Corner> incident;
  const Vec3& vertex;
};
/// The same for two edges, with the faces beside them that EdgesMeeting chooses.
struct EdgeOnEdge {
  const CollisionShape::Edge &a, &b;
  CollisionShape::FaceView beside_a, beside_b;
};

// ---- a face of one body clipped by the sides of a face of the other

/// Sutherland-Hodgman clipping with keys for the corners. Holds scratch memory; one per thread.
class FaceClipper {
 public:
  /// Reserves room for every polygon of ordinary grains. Clipping swaps the buffers, so each of
  /// them must be large enough from the start.
  FaceClipper() {
    polygon_.reserve(room);
    clipped_.reserve(room);
    distance_.reserve(room);
  }

  using FaceView = CollisionShape::FaceView;

  /// Returns the part of the face with corners `incident` of body 1 - `reference` that lies within
  /// the prism on face `face` of body `reference`, counter-clockwise seen from the incident body's
  /// outside. The prism runs along the face's normal or, if given, along `direction`, a unit vector
  /// in the reference body's frame; the face's sides are then not read. Corners up to
  /// clipping_thickness() outside a side stay where they are. Valid until the next call.
  std::span<ClippedPoint> clip(const PairFrame& pair, int reference, const FaceView& face,
                               std::span<const CollisionShape::Corner> incident,
                               const Vec3* direction = nullptr);

 private:
  static constexpr size_t room = 128;
  void clip_by_side(int reference, const FaceView& face, int k, const CollisionShape::Side& side,
                    double thickness);

  std::vector<ClippedPoint> polygon_, clipped_;
  std::vector<double> distance_;
};

// ---- one point only
//
// Most manifolds are one vertex over a face, whose place is known from the axis. A proof from the
// features' records alone saves the clipping of faces and the reading of the shapes' tables. It is
// sufficient, not necessary: where it fails, the points are collected, which gives the same point
// to the same bits.

/// Corners up to this far outside a side of a face [m] still count as on the face. `size`: the
/// pair's PairFrame::size().
constexpr double clipping_thickness(double size) { return 1e-9 * size; }

/// Whether the support vertex of the axis, which must be a face, is proved to be the only point
/// within limits.alert: all else of the other body rises out of reach before it gets to the face's
/// sides or to another vertex. The axis' clearance may be a lower bound.
bool is_lone_vertex(const PairFrame& pair, const SeparatingAxis& axis,
                    const ManifoldLimits& limits);

/// Holds scratch memory; one per thread.
class ContactManifold {
 public:
  /// Returns the pair's points within the limits, sorted by key. The axis must be the pair's best
  /// and its separation <= alert. Unless the pair is a joint, the smallest gap equals the
  /// separation: the touching vertex is added if clipping has lost it. Valid until the next call.
  std::span<const ManifoldPoint> points(const ShapePair& pair, const SeparatingAxis& axis,
                                        const ManifoldLimits& limits);
  /// The same from the features alone, for pairs whose point is not proved to be the only one; for
  /// two edges, if they are flat.
  std::span<const ManifoldPoint> points(const PairFrame& pair, const SeparatingAxis& axis,
                                        const FaceOnFace& faces, const ManifoldLimits& limits);
  std::span<const ManifoldPoint> points(const PairFrame& pair, const SeparatingAxis& axis,
                                        const EdgesMeeting& meeting, const EdgeOnEdge& edges,
                                        const ManifoldLimits& limits);
  /// The crossing of two edges that are not flat; none at a joint.
  std::span<const ManifoldPoint> crossing(const PairFrame& pair, const SeparatingAxis& axis,
                                          const CollisionShape::Edge& a,
                                          const CollisionShape::Edge& b,
                                          const ManifoldLimits& limits);
  /// The only point of the pair.
  std::span<const ManifoldPoint> lone_point(const PairFrame& pair, const SeparatingAxis& axis,
                                            const ClippedPoint& place);

 private:
  std::span<const ManifoldPoint> chosen_points(const PairFrame& pair, const SeparatingAxis& axis,
                                               int max_points);
  void reduce(int max_points, double size);

  FaceClipper clipper_;
  CollisionShape::FaceTable face_of_[2];  // the pair's faces, copied from the shapes' tables
  // The points within reach, in the order of the polygon's corners, in the reference body's frame.
  std::vector<ClippedPoint> candidates_;
  std::vector<int> by_key_;  // candidates in the order of their keys
  std::vector<char> chosen_;
  std::vector<ManifoldPoint> points_;
};

}  // namespace ballast
