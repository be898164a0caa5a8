#include "geometry/contact/touching_pair.hpp"

#include <algorithm>
#include <limits>

namespace ballast {

namespace {

constexpr double largest = std::numeric_limits<double>::max();

/// The lowest of an incident face's corners over a reference face, and how far it lies below the
/// others.
struct LowestCorner {
  int place = 0;  // in the face's loop; the smallest vertex among equals
  double height = largest, clearance = largest;
};
LowestCorner lowest_corner(std::span<const CollisionShape::Corner> corners, const Vec3& direction) {
  LowestCorner low;
  double second = largest;
  for (size_t k = 0; k < corners.size(); ++k) {
    const double height = vertex_height(direction, corners[k].position);
    const bool is_lower = height < low.height ||
                          (height == low.height && corners[k].vertex < corners[low.place].vertex);
    second = std::min(second, is_lower ? low.height : height);
    if (!is_lower) continue;
    low.height = height;
    low.place = static_cast<int>(k);
  }
  low.clearance = second - low.height;
  return low;
}

}  // namespace

void TouchingPair::record(const ShapePair& pair, const SeparatingAxis& axis, double turn,
                          Heights& heights) {
  contact_ = std::monostate{};
  feature_ = axis.feature;
  if (feature_.kind == AxisKind::edges)
    record_edges(pair, axis);
  else
    record_faces(pair, axis.support, turn, heights);
}

void TouchingPair::record_edges(const ShapePair& pair, const SeparatingAxis& axis) {
  Edges& edges = contact_.emplace<Edges>();
  edges.face[0] = edges.face[1] = -1;
  edges.a = pair.shape[0]->edge(feature_.a);
  edges.b = pair.shape[1]->edge(feature_.b);
  const EdgesMeeting meeting(pair, axis, edges.a, edges.b);
  const int face[2] = {meeting.face_a, meeting.face_b};
  const int corners[2] = {pair.shape[0]->corner_count(face[0]),
                          pair.shape[1]->corner_count(face[1])};
  if (meeting.is_sharp() || std::max(corners[0], corners[1]) > static_cast<int>(most)) return;
  for (int body = 0; body < 2; ++body) {
    edges.face[body] = face[body];
    Corners& kept = edges.beside[body];
    kept.count = corners[body];
    kept.offset = pair.shape[body]->face(face[body]).offset;
    for (int k = 0; k < corners[body]; ++k)
      kept.corner[k] = pair.shape[body]->corner(face[body], k);
  }
}

void TouchingPair::record_faces(const ShapePair& pair, int support, double turn, Heights& heights) {
  const int own = feature_.reference(), f = feature_.face();
  const CollisionShape &shape = *pair.shape[own], &other = *pair.shape[1 - own];
  const int incident = incident_face(pair, own, f, support);
  const int sides = shape.corner_count(f), count = other.corner_count(incident);
  if (std::max(sides, count) > static_cast<int>(most)) return;
  Faces& faces = contact_.emplace<Faces>();
  faces.reference = shape.face(f);
  faces.side_count = sides;
  for (int k = 0; k < sides; ++k) {
    const CollisionShape::Corner corner = shape.corner(f, k);
    faces.side[k] = shape.side(f, k);
    faces.corner[k] = {static_cast<std::uint16_t>(corner.vertex),
                       static_cast<std::uint16_t>(corner.edge)};
  }
  faces.incident_count = count;
  for (int k = 0; k < count; ++k) faces.incident[k] = other.corner(incident, k);
  faces.turn = turn;
  const std::span<const CollisionShape::Corner> corners(faces.incident.data(), count);
  // The least height of all other vertices over the support vertex.
  const Vec3 direction = pair.other[1 - own].rotation * faces.reference.normal;
  other.vertices().evaluate(direction, heights.data());
  const double lowest = heights[support];
  for (const CollisionShape::Corner& corner : corners) heights[corner.vertex] = largest;
  faces.clearance = *std::min_element(heights.begin(), heights.begin() + other.vertices().count());
  faces.clearance -= lowest;
  // The faces that compete with the incident one, corner by corner.
  const double cosine = other.face(incident).normal.dot(direction);
  for (size_t k = 0; k < corners.size(); ++k) {
    faces.lead[k] = largest;
    const int vertex = corners[k].vertex;
    for (int i = 0; i < other.vertex_face_count(vertex); ++i)
      if (const int g = other.vertex_face(vertex, i); g != incident)
        faces.lead[k] = std::min(faces.lead[k], other.face(g).normal.dot(direction) - cosine);
  }
}

TouchingPair::Answer TouchingPair::look(const PairFrame& pair, double turn,
                                        const ManifoldLimits& limits,
                                        ContactManifold& manifold) const {
  if (const auto* faces = std::get_if<Faces>(&contact_))
    return look_at(*faces, pair, turn, limits, manifold);
  if (const auto* edges = std::get_if<Edges>(&contact_))
    return look_at(*edges, pair, limits, manifold);
  return {};
}

TouchingPair::Answer TouchingPair::look_at(const Faces& faces, const PairFrame& pair, double turn,
                                           const ManifoldLimits& limits,
                                           ContactManifold& manifold) const {
  const int own = feature_.reference();
  const CollisionShape::Face& reference = faces.reference;
  const std::span<const CollisionShape::Side> sides(faces.side.data(), faces.side_count);
  const std::span<const CollisionShape::Corner> incident(faces.incident.data(),
                                                         faces.incident_count);
  const Vec3 direction = pair.other[1 - own].rotation * reference.normal;
  const LowestCorner low = lowest_corner(incident, direction);
  // Other vertices may have come nearer to the face by as much as the bodies have turned since. The
  // term 1e-9 is far above the rounding of sums of turns over 1e7 steps.
  const double turned = turn - faces.turn + 1e-9 * (1.0 + turn);
  const double diameter = 2.0 * pair.bounds[1 - own]->circumradius;
  const double clearance = std::min(low.clearance, faces.clearance - diameter * turned);
  if (!(clearance > proof_margin(pair))) return {};  // another vertex may be the lowest
  const double separation = face_separation_at(pair, own, reference, low.height);
  if (separation > limits.alert)
    return {PairOutcome::apart, {.feature = feature_, .separation = separation}};
  // The axis and its proof.
  const CollisionShape::Corner& support = incident[low.place];
  const auto side_at = [&](int k) -> const CollisionShape::Side& { return sides[k]; };
  SeparatingAxis axis =
      face_axis(pair, feature_, reference, faces.side_count, side_at, support.position, separation);
  axis.support = support.vertex;
  axis.clearance = clearance;
  if (!is_proved_best(pair, reference.isolation, axis)) return {};
  // One point, or the common part of the two faces if the incident face is still the same.
  if (is_lone_vertex(pair, axis, limits))
    return {
        PairOutcome::touching, axis,
        manifold.lone_point(pair, axis, vertex_on_face(pair, axis, reference, support.position))};
  if (!(faces.lead[low.place] - 2.0 * turned > 2.0 * equal_cosines)) return {};
  std::array<CollisionShape::Corner, most> corners;  // only their vertex and edge indices are read
  for (size_t k = 0; k < sides.size(); ++k)
    corners[k] = {faces.corner[k].vertex, faces.corner[k].edge, Vec3::Zero()};
  const FaceOnFace met{
      {reference, {corners.data(), sides.size()}, sides}, incident, support.position};
  return {PairOutcome::touching, axis, manifold.points(pair, axis, met, limits)};
}

TouchingPair::Answer TouchingPair::look_at(const Edges& edges, const PairFrame& pair,
                                           const ManifoldLimits& limits,
                                           ContactManifold& manifold) const {
  const std::optional<EdgeSeparation> facet = edge_facet(pair, edges.a, edges.b);
  if (!facet || facet->nearly_parallel) return {};
  if (facet->separation > limits.alert)
    return {PairOutcome::apart, {.feature = feature_, .separation = facet->separation}};
  const SeparatingAxis axis = edge_axis(pair, feature_, edges.a, edges.b, *facet);
  if (!is_proved_best(pair, 1.0, axis)) return {};
  // The crossing alone, or the common part of the faces beside the edges if they are the same.
  const EdgesMeeting meeting(pair, axis, edges.a, edges.b);
  if (meeting.is_sharp())
    return {PairOutcome::touching, axis, manifold.crossing(pair, axis, edges.a, edges.b, limits)};
  if (meeting.face_a != edges.face[0] || meeting.face_b != edges.face[1]) return {};
  const auto plane = [&](const CollisionShape::Edge& edge, int body) {
    const bool is_left = edges.face[body] == edge.left;
    return CollisionShape::Face{is_left ? edge.left_normal : edge.right_normal,
                                edges.beside[body].offset, 0.0};
  };
  const CollisionShape::Face face_a = plane(edges.a, 0), face_b = plane(edges.b, 1);
  const EdgeOnEdge met{
      edges.a, edges.b, {face_a, edges.beside[0].all(), {}}, {face_b, edges.beside[1].all(), {}}};
  return {PairOutcome::touching, axis, manifold.points(pair, axis, meeting, met, limits)};
}

}  // namespace ballast
