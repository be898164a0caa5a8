#pragma once
// Proofs that the contact rule gives a pair one point only, from the features' records alone.
//
// Most manifolds are one vertex over a face or two edges across, and their place is known from the
// axis. A proof spares the clipping of faces, and the look at the shapes' tables. Each is
// sufficient, not necessary: a pair without a proof is left to contact_manifold.hpp, which gives
// the same point, to the same bits.

#include "geometry/contact/contact_normal.hpp"

namespace ballast {

/// Corners up to this far outside a side of a face [m] still count as on the face. `size`: of the
/// pair.
constexpr double clipping_thickness(double size) { return 1e-9 * size; }

/// The axis is a face and its support vertex is the only point within `alert` [m]: everything else
/// of the other body rises out of reach before it gets to the sides or to another vertex. The
/// axis' clearance may be a lower bound.
bool is_lone_vertex(const PairFrame& pair, const SeparatingAxis& axis, double alert);

/// An edge and a face beside it, by the planes on the face's sides.
struct EdgeOfFace {
  const CollisionShape::Edge& edge;
  std::span<const CollisionShape::Side> sides;
  int own;  ///< the side that stands on the edge
};
/// `index`: of the edge in its shape.
EdgeOfFace edge_of_face(const CollisionShape::Edge& edge, int index,
                        const CollisionShape::FaceView& face);

/// The axis is two edges, flat on one another, and their crossing is the only point within `alert`
/// [m]: all other corners of the common part of the two faces (`meeting`'s) are out of reach.
bool is_lone_crossing(const PairFrame& pair, const SeparatingAxis& axis,
                      const EdgesMeeting& meeting, const EdgeOfFace& a, const EdgeOfFace& b,
                      double alert);

}  // namespace ballast
