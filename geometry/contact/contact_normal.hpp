#pragma once
// The contact rule: which normal, which gaps and which points a touching pair has. This is the one
// place to read, cite or change it.
//
// The search (axis_search.hpp) proves which facet of the Minkowski difference B - A separates two
// polyhedra best: a face of a, a face of b, or an edge of each. It hands over that feature, the
// unit direction d across it (a's frame, from a to b) and the separation s along d. From the
// feature, the two bodies' records and their relative pose, this module finds the places where the
// bodies are near each other, with their heights h_i along d, min h_i = s, and decides
//
//   the normal  n    unit, from a to b, one for all points of the pair:  n = d
//   the gaps    g_i  along n [m]; negative where the bodies overlap:     g_i = h_i
//   the points  x_i  midway between the two surfaces:  x = x_b - g/2 n = x_a + g/2 n
//
// with x_a and x_b the places on the surfaces of a and b. The proofs need only d, s and h and the
// contact law only n, g and x: another rule changes contact_normal, contact_gap and contact_at
// below and nothing in the search.
//
// clang-format off
// case            feature     normal n          places                         height h of place x
// --------------  ----------  ----------------  -----------------------------  -------------------
// face on face,   face f of   n_f of the        corners of the common part:    n_f.x - o_f, over
// edge on face    one body    reference face,   the other body's face at the   the plane of f
//                             turned round for  touching vertex that opposes
//                             a face of b       f most, cut by f's sides
// vertex on face  face f      the same          the touching vertex            the same
// edge on edge    an edge of  e_a x e_b at      closest points of the two      d.(x_b - x_a), the
//                 each        length 1, a to b  lines, held within the edges   separation s
// flat edges      an edge of  the same          that point and the corners of  (n_f.x - o_f)/n_f.d
//                 each                          the common part of the faces
//                                               beside the edges, cut along d
// parallel edges  never a feature (parallel_sine): the faces beside them separate as well
// plane           a wall      the plane's n_P   every vertex within reach      n_P.(x - p)
// clang-format on
//
// "Flat edges" (EdgesMeeting) lie nearly in a face of the other body. Such an edge touches at both
// ends of its overlap, not only where the axis happens to see it in this step: without the other
// end, contact would jump from end to end as the body rocks by micrometres.
//
// The direction of least overlap is that of Cameron and Culley, "Determining the minimum
// translational distance between two convex polyhedra", ICRA 1986. The points are chosen as in
// Gregorius, "Robust contact creation for physics simulations", GDC 2015; the flat edges are ours.
//
// The callers: contact_manifold.hpp proves that the rule gives no more than one point, or collects
// the points within reach and keeps the most useful ones; detection_part.cpp turns them to the
// world frame. Places are collected by their heights, so that a rule whose gaps are smaller than
// the heights misses some at the rim.

#include "geometry/contact/contact_point.hpp"
#include "geometry/contact/separating_axis.hpp"

namespace ballast {

/// A contact point of two polyhedra, in a's frame.
struct ManifoldPoint {
  std::uint64_t key;  ///< unique within the pair (contact_point.hpp)
  Vec3 position;      ///< midway between the two surfaces [m]
  double gap;         ///< along the normal [m]; negative = overlap
};

// ---- the normal

/// The normal of all points of a pair of polyhedra: unit, in a's frame, from a to b.
inline Vec3 contact_normal(const PairFrame& /*pair*/, const SeparatingAxis& axis) {
  return axis.direction;
}
/// The same on a plane: unit, world frame, into the free side. `rotation`: R_WB of the plane.
inline Vec3 contact_normal(const Mat3& rotation, const Plane& plane) {
  return rotation * plane.normal;
}

// ---- the places, with their heights along the axis' direction

/// A corner of a clipped polygon.
struct ClippedPoint {
  Vec3 position;  ///< in the reference body's frame [m]
  double height;  ///< over the reference face [m]; set by set_heights()
  std::uint64_t key;
  int next_edge;  ///< to the next corner: edge e of the incident body, or ~k for side k of the
                  ///< reference face
};

/// The height of a place x on the other body over a reference face, in that face's frame [m].
inline double height_over_face(const CollisionShape::Face& face, const Vec3& x) {
  return face.normal.dot(x) - face.offset;
}
/// Sets the heights of all corners of the common part of two faces that the planes on the sides of
/// the reference face have cut out. With `direction`, a unit vector out of the reference face in
/// its frame, corners are cut, and heights measured, along it.
inline void set_heights(std::span<ClippedPoint> corners, const CollisionShape::Face& face,
                        const Vec3* direction = nullptr) {
  const double scale = direction ? 1.0 / face.normal.dot(*direction) : 1.0;
  for (ClippedPoint& corner : corners)
    corner.height = height_over_face(face, corner.position) * scale;
}
/// The axis' support vertex over its face. `vertex`: in its own body's frame [m].
ClippedPoint vertex_on_face(const PairFrame& pair, const SeparatingAxis& axis,
                            const CollisionShape::Face& face, const Vec3& vertex);
/// The closest points of the axis' two edges, as a place on b's surface in a's frame. The lines of
/// bodies apart may be closest beyond the edges' ends; the points are then held at the ends.
ClippedPoint edges_cross(const PairFrame& pair, const SeparatingAxis& axis,
                         const CollisionShape::Edge& a, const CollisionShape::Edge& b);

/// How the two edges of an axis and the faces beside them lie: a crossing, or flat on one another.
struct EdgesMeeting {
  EdgesMeeting(const PairFrame& pair, const SeparatingAxis& axis, const CollisionShape::Edge& a,
               const CollisionShape::Edge& b);

  int face_a, face_b;         ///< of the two faces beside each edge, the one facing the other body
  bool flat_on_a, flat_on_b;  ///< the other body lies nearly flat on that face
  bool across;                ///< the edges are not nearly parallel
  /// True if neither body lies flat on the other: the crossing is the only point. An edge along the
  /// face's own side has no second end on the face, hence "across".
  bool is_sharp() const {
    return !(flat_on_a && flat_on_b) && !(across && (flat_on_a || flat_on_b));
  }
  /// For flat edges: the body (0 = a) whose face is the reference.
  int reference() const { return flat_on_a ? 0 : 1; }
};

// ---- the gaps and the points

/// The gap along the normal [m] of a place at this height along the axis' direction.
inline double contact_gap(const PairFrame& /*pair*/, const SeparatingAxis& /*axis*/,
                          double height) {
  return height;
}
/// The point midway between the surfaces, from the place on b's surface or on a's.
inline Vec3 midway_from_b(const Vec3& on_b, double gap, const Vec3& normal) {
  return on_b - 0.5 * gap * normal;
}
inline Vec3 midway_from_a(const Vec3& on_a, double gap, const Vec3& normal) {
  return on_a + 0.5 * gap * normal;
}
/// The contact point of a place on the surface of the body beside the reference, in the
/// reference's frame: on b for a face of a and for two edges, on a for a face of b.
ManifoldPoint contact_at(const PairFrame& pair, const SeparatingAxis& axis,
                         const ClippedPoint& place);

}  // namespace ballast
