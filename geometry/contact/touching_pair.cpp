#include "geometry/contact/touching_pair.hpp"

#include <algorithm>
#include <limits>

namespace ballast {

namespace {

constexpr double largest = std::numeric_limits<double>::max();

EdgeOfFace edge_of_copy(const CollisionShape::Edge& edge, const FaceCopy& face, int own) {
  return {edge, face.view().sides, own};
}

/// The lowest of an incident face's corners over a reference face, and how far it lies below the
/// others.
struct LowestCorner {
  int place = 0;  // in the face's loop; of equals the smallest vertex
  double height = largest, clearance = largest;
};
LowestCorner lowest_corner(const FaceCopy& face, const Vec3& direction) {
  LowestCorner low;
  double second = largest;
  for (int k = 0; k < face.count; ++k) {
    const double height = vertex_height(direction, face.corner[k].position);
    const bool is_lower =
        height < low.height ||
        (height == low.height && face.corner[k].vertex < face.corner[low.place].vertex);
    second = std::min(second, is_lower ? low.height : height);
    if (!is_lower) continue;
    low.height = height;
    low.place = k;
  }
  low.clearance = second - low.height;
  return low;
}

}  // namespace

bool FaceCopy::take(const CollisionShape& shape, int f) {
  index = -1;
  if (shape.corner_count(f) > static_cast<int>(most)) return false;
  index = f;
  count = shape.corner_count(f);
  face = shape.face(f);
  for (int k = 0; k < count; ++k) {
    side[k] = shape.side(f, k);
    corner[k] = shape.corner(f, k);
  }
  return true;
}

void TouchingPair::record(const ShapePair& pair, const SeparatingAxis& axis, double turn,
                          Heights& heights) {
  contact_ = std::monostate{};
  feature_ = axis.feature;
  if (feature_.kind != AxisKind::edges) return record_faces(pair, axis.support, turn, heights);
  Edges& edges = contact_.emplace<Edges>();
  edges.a = pair.shape[0]->edge(feature_.a);
  edges.b = pair.shape[1]->edge(feature_.b);
  const EdgesMeeting meeting(pair, axis, edges.a, edges.b);
  if (edges.beside_a.face.take(*pair.shape[0], meeting.face_a))
    edges.beside_a.own = edge_of_face(edges.a, feature_.a, edges.beside_a.face.view()).own;
  if (edges.beside_b.face.take(*pair.shape[1], meeting.face_b))
    edges.beside_b.own = edge_of_face(edges.b, feature_.b, edges.beside_b.face.view()).own;
}

void TouchingPair::record_faces(const ShapePair& pair, int support, double turn, Heights& heights) {
  const int own = feature_.reference(), f = feature_.face();
  const CollisionShape& other = *pair.shape[1 - own];
  const int incident = incident_face(pair, own, f, support);
  Faces& faces = contact_.emplace<Faces>();
  if (!faces.reference.take(*pair.shape[own], f) || !faces.incident.take(other, incident)) {
    contact_ = std::monostate{};
    return;
  }
  faces.turn = turn;
  const std::span<const CollisionShape::Corner> corners = faces.incident.view().corners;
  // All other vertices' heights over the support's.
  const Vec3 direction = pair.other[1 - own].rotation * faces.reference.face.normal;
  other.vertices().evaluate(direction, heights.data());
  const double lowest = heights[support];
  for (const CollisionShape::Corner& corner : corners) heights[corner.vertex] = largest;
  faces.clearance = *std::min_element(heights.begin(), heights.begin() + other.vertices().count());
  faces.clearance -= lowest;
  // The faces that compete with the incident one, corner by corner.
  const double cosine = faces.incident.face.normal.dot(direction);
  for (size_t k = 0; k < corners.size(); ++k) {
    faces.lead[k] = largest;
    const int vertex = corners[k].vertex;
    for (int i = 0; i < other.vertex_face_count(vertex); ++i)
      if (const int g = other.vertex_face(vertex, i); g != incident)
        faces.lead[k] = std::min(faces.lead[k], other.face(g).normal.dot(direction) - cosine);
  }
}

TouchingPair::Look TouchingPair::look(const PairFrame& pair, double turn, double alert,
                                      int max_points, ContactManifold& manifold,
                                      SeparatingAxis& axis,
                                      std::span<const ManifoldPoint>& points) const {
  if (const auto* faces = std::get_if<Faces>(&contact_))
    return look_at(*faces, pair, turn, alert, max_points, manifold, axis, points);
  if (const auto* edges = std::get_if<Edges>(&contact_))
    return look_at(*edges, pair, alert, max_points, manifold, axis, points);
  return Look::undecided;
}

TouchingPair::Look TouchingPair::look_at(const Faces& faces, const PairFrame& pair, double turn,
                                         double alert, int max_points, ContactManifold& manifold,
                                         SeparatingAxis& axis,
                                         std::span<const ManifoldPoint>& points) const {
  const int own = feature_.reference();
  const CollisionShape::FaceView reference = faces.reference.view();
  const Vec3 direction = pair.other[1 - own].rotation * reference.face.normal;
  const LowestCorner low = lowest_corner(faces.incident, direction);
  // Other vertices may have come nearer to the face by as much as the bodies have turned since. The
  // term 1e-9 is far above the rounding of sums of turns over 1e7 steps.
  const double turned = turn - faces.turn + 1e-9 * (1.0 + turn);
  const double diameter = 2.0 * pair.bounds[1 - own]->circumradius;
  const double clearance = std::min(low.clearance, faces.clearance - diameter * turned);
  if (!(clearance > proof_margin(pair)))
    return Look::undecided;  // another vertex may be the lowest
  const double separation = face_separation_at(pair, own, reference.face, low.height);
  axis.separation = separation;
  if (separation > alert) return Look::apart;
  // The axis and its proof.
  const CollisionShape::Corner& support = faces.incident.corner[low.place];
  const auto side_at = [&](int k) -> const CollisionShape::Side& { return reference.sides[k]; };
  axis = face_axis(pair, feature_, reference.face, static_cast<int>(reference.sides.size()),
                   side_at, support.position, separation);
  axis.support = support.vertex;
  axis.clearance = clearance;
  if (!is_proved_best(pair, reference.face.isolation, axis)) return Look::undecided;
  // One point, or the common part of the two faces if the incident face is the same still.
  if (is_lone_vertex(pair, axis, alert)) {
    points = manifold.lone_point(pair, axis,
                                 vertex_on_face(pair, axis, reference.face, support.position));
    return Look::touching;
  }
  if (!(faces.lead[low.place] - 2.0 * turned > 2.0 * equal_cosines)) return Look::undecided;
  points = manifold.points(pair, axis, {reference, faces.incident.view(), support.position}, alert,
                           max_points);
  return Look::touching;
}

TouchingPair::Look TouchingPair::look_at(const Edges& edges, const PairFrame& pair, double alert,
                                         int max_points, ContactManifold& manifold,
                                         SeparatingAxis& axis,
                                         std::span<const ManifoldPoint>& points) const {
  const std::optional<EdgeSeparation> facet = edge_facet(pair, edges.a, edges.b);
  if (!facet || facet->nearly_parallel) return Look::undecided;
  axis.separation = facet->separation;
  if (facet->separation > alert) return Look::apart;
  axis = edge_axis(pair, feature_, edges.a, edges.b, *facet);
  if (!is_proved_best(pair, 1.0, axis)) return Look::undecided;
  // The crossing alone, or the common part of the faces beside the edges if they are the same.
  const EdgesMeeting meeting(pair, axis, edges.a, edges.b);
  const FaceCopy &face_a = edges.beside_a.face, &face_b = edges.beside_b.face;
  const bool is_sharp = meeting.is_sharp();
  if (!is_sharp && (meeting.face_a != face_a.index || meeting.face_b != face_b.index))
    return Look::undecided;
  const bool is_lone =
      is_sharp ||
      is_lone_crossing(pair, axis, meeting, edge_of_copy(edges.a, face_a, edges.beside_a.own),
                       edge_of_copy(edges.b, face_b, edges.beside_b.own), alert);
  points = is_lone ? manifold.lone_point(pair, axis, edges_cross(pair, axis, edges.a, edges.b))
                   : manifold.points(pair, axis, meeting,
                                     {edges.a, edges.b, face_a.view(), face_b.view()}, alert,
                                     max_points);
  return Look::touching;
}

}  // namespace ballast
