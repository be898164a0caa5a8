#include "geometry/contact/touching_pair.hpp"

#include <algorithm>

namespace ballast {

namespace {

EdgeAcrossEdge::Beside beside(const EdgeOfFace& found, int face) {
  EdgeAcrossEdge::Beside beside;
  if (!beside.sides.keep(found.sides)) return beside;
  beside.face = face;
  beside.own = found.own;
  return beside;
}

EdgeOfFace remembered(const CollisionShape::Edge& edge, const EdgeAcrossEdge::Beside& beside) {
  return {edge, beside.sides.all(), beside.own};
}

}  // namespace

bool FewSides::keep(std::span<const CollisionShape::Side> sides) {
  if (sides.size() > most) return false;
  count = static_cast<int>(sides.size());
  std::copy(sides.begin(), sides.end(), side.begin());
  return true;
}

void TouchingPair::record(const ShapePair& pair, const SeparatingAxis& axis, double turn) {
  contact_ = std::monostate{};
  feature_ = axis.feature;
  if (feature_.kind == AxisKind::edges) {
    const CollisionShape::Edge &a = pair.shape[0]->edges()[feature_.a],
                               &b = pair.shape[1]->edges()[feature_.b];
    const EdgesMeeting meeting(pair, axis, a, b);
    contact_ = EdgeAcrossEdge{
        a, b, beside(edge_of_face(*pair.shape[0], feature_.a, meeting.face_a), meeting.face_a),
        beside(edge_of_face(*pair.shape[1], feature_.b, meeting.face_b), meeting.face_b)};
    return;
  }
  const int own = feature_.reference(), f = feature_.face();
  VertexOnFace contact;
  if (!contact.sides.keep(pair.shape[own]->sides(f))) return;
  contact.face = pair.shape[own]->face(f);
  contact.vertex = pair.shape[1 - own]->vertices().xyz(axis.support);
  contact.support = axis.support;
  contact.clearance = axis.clearance;
  contact.turn = turn;
  contact_ = contact;
}

TouchingPair::Look TouchingPair::look(const PairFrame& pair, double turn, double alert,
                                      SeparatingAxis& axis, ManifoldPoint& point) const {
  if (const auto* vertex = std::get_if<VertexOnFace>(&contact_))
    return look_at(*vertex, pair, turn, alert, axis, point);
  if (const auto* edges = std::get_if<EdgeAcrossEdge>(&contact_))
    return look_at(*edges, pair, alert, axis, point);
  return Look::undecided;
}

TouchingPair::Look TouchingPair::look_at(const VertexOnFace& contact, const PairFrame& pair,
                                         double turn, double alert, SeparatingAxis& axis,
                                         ManifoldPoint& point) const {
  const int own = feature_.reference();
  // Another vertex may come nearer to the face by as much as the bodies have turned since. The term
  // 1e-9 is far above the rounding of sums of turns over 1e7 steps.
  const double diameter = 2.0 * pair.bounds[1 - own]->circumradius;
  const double clearance =
      contact.clearance - diameter * (turn - contact.turn + 1e-9 * (1.0 + turn));
  if (!(clearance > proof_margin(pair)))
    return Look::undecided;  // another vertex may be the lowest
  const Vec3 direction = pair.other[1 - own].rotation * contact.face.normal;
  const double separation =
      face_separation_at(pair, own, contact.face, vertex_height(direction, contact.vertex));
  axis.separation = separation;
  if (separation > alert) return Look::apart;
  axis = face_axis(pair, feature_, contact.face, contact.sides.all(), contact.vertex, separation);
  axis.support = contact.support;
  axis.clearance = clearance;
  if (!is_lone_vertex(pair, axis, alert) || !is_proved_best(pair, contact.face.isolation, axis))
    return Look::undecided;
  point = contact_at(pair, axis, vertex_on_face(pair, axis, contact.face, contact.vertex));
  return Look::touching;
}

TouchingPair::Look TouchingPair::look_at(const EdgeAcrossEdge& contact, const PairFrame& pair,
                                         double alert, SeparatingAxis& axis,
                                         ManifoldPoint& point) const {
  const std::optional<EdgeFacet> facet = edge_facet(pair, contact.a, contact.b);
  if (!facet || facet->nearly_parallel) return Look::undecided;
  axis.separation = facet->separation;
  if (facet->separation > alert) return Look::apart;
  axis = edge_axis(pair, feature_, contact.a, contact.b, *facet);
  const EdgesMeeting meeting(pair, axis, contact.a, contact.b);
  const bool is_known =
      meeting.face_a == contact.beside_a.face && meeting.face_b == contact.beside_b.face;
  const bool is_lone =
      meeting.is_sharp() ||
      (is_known && is_lone_crossing(pair, axis, meeting, remembered(contact.a, contact.beside_a),
                                    remembered(contact.b, contact.beside_b), alert));
  if (!is_lone || !is_proved_best(pair, 1.0, axis)) return Look::undecided;
  point = contact_at(pair, axis, edges_cross(pair, axis, contact.a, contact.b));
  return Look::touching;
}

}  // namespace ballast
