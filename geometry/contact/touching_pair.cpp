#include "geometry/contact/touching_pair.hpp"

#include <algorithm>

namespace ballast {

namespace {

EdgeAcrossEdge::Beside beside(const CollisionShape& shape, int face, int edge) {
  EdgeAcrossEdge::Beside beside;
  const SidesBesideEdge found = sides_beside(shape, face, edge);
  if (found.sides.size() > EdgeAcrossEdge::most_sides) return beside;
  beside.face = face;
  beside.own = found.own;
  beside.count = static_cast<int>(found.sides.size());
  std::copy(found.sides.begin(), found.sides.end(), beside.sides.begin());
  return beside;
}

SidesBesideEdge sides_of(const EdgeAcrossEdge::Beside& beside) {
  return {{beside.sides.data(), static_cast<size_t>(beside.count)}, beside.own};
}

}  // namespace

void TouchingPair::record(const ShapePair& pair, const SeparatingAxis& axis, double turn) {
  contact_ = std::monostate{};
  feature_ = axis.feature;
  if (feature_.kind == AxisKind::edges) {
    const CollisionShape::Edge &a = pair.shape[0]->edges()[feature_.a],
                               &b = pair.shape[1]->edges()[feature_.b];
    const EdgeCrossing edges(pair, axis, a, b);
    contact_ = EdgeAcrossEdge{a, b, beside(*pair.shape[0], edges.face_a, feature_.a),
                              beside(*pair.shape[1], edges.face_b, feature_.b)};
    return;
  }
  const int own = feature_.kind == AxisKind::face_of_a ? 0 : 1;
  const int f = own == 0 ? feature_.a : feature_.b;
  const std::span<const CollisionShape::Side> sides = pair.shape[own]->sides(f);
  if (sides.size() > VertexOnFace::most_sides) return;
  VertexOnFace contact;
  contact.face = pair.shape[own]->face(f);
  std::copy(sides.begin(), sides.end(), contact.sides.begin());
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
  const int own = feature_.kind == AxisKind::face_of_a ? 0 : 1;
  // 1e-9: far above the rounding of sums of turns over 1e7 steps
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
  const std::span<const CollisionShape::Side> sides(contact.sides.data(),
                                                    static_cast<size_t>(contact.face.corner_count));
  axis = face_axis(pair, feature_, contact.face, sides, contact.vertex, separation);
  axis.support = contact.support;
  axis.clearance = clearance;
  if (!is_lone_vertex(pair, axis, alert) || !is_proved_best(pair, contact.face.isolation, axis))
    return Look::undecided;
  point = lone_vertex(pair, axis, contact.face, contact.vertex);
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
  const EdgeCrossing edges(pair, axis, contact.a, contact.b);
  const bool known = edges.face_a == contact.beside_a.face && edges.face_b == contact.beside_b.face;
  const bool lone =
      edges.is_sharp() || (known && edges.rises_out_of_reach(pair, axis, contact.a, contact.b,
                                                             sides_of(contact.beside_a),
                                                             sides_of(contact.beside_b), alert));
  if (!lone || !is_proved_best(pair, 1.0, axis)) return Look::undecided;
  point = crossing_point(pair, axis, contact.a, contact.b);
  return Look::touching;
}

}  // namespace ballast
