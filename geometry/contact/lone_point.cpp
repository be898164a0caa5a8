#include "geometry/contact/lone_point.hpp"

#include <algorithm>
#include <cmath>

namespace ballast {

/// All other vertices are at least `clearance` higher and at most a diameter away from the support
/// vertex, so that the body rises from it with at least the slope clearance / diameter.
bool is_lone_vertex(const PairFrame& pair, const SeparatingAxis& axis, double alert) {
  const double thickness = clipping_thickness(pair.size());
  const double diameter = 2.0 * pair.bounds[1 - axis.feature.reference()]->circumradius;
  const double slope = axis.clearance / diameter;
  // At the nearest side of the face, `inside` away, the body is at least slope times inside higher
  // than its support vertex: what the side cuts is out of reach, and so is every other vertex.
  return axis.inside > thickness && axis.separation + slope * axis.inside > alert + thickness &&
         axis.separation + axis.clearance > alert + thickness;
}

EdgeOfFace edge_of_face(const CollisionShape::Edge& edge, int index,
                        const CollisionShape::FaceView& face) {
  int own = 0;
  while (face.corners[own].edge != index) ++own;
  return {edge, face.sides, own};
}

/// Over the faces' common part the height between them is a linear function. It is least at the
/// crossing x0, and the part's corner there lies between the directions of the two edges. Each of
/// these is tilted along the axis into the incident plane, which stretches it by
/// sqrt(1 + rise^2). Let `room` be the distance from x0 to the nearest other side of either face.
/// Nearer than that no other side cuts, so every other corner is at least that far from x0 and at
/// least room times the lesser slope higher. The sides of the reference face are cut along the
/// axis instead of its normal: the factor 0.98 allows for the cosine of at least 0.99 between them.
bool is_lone_crossing(const PairFrame& pair, const SeparatingAxis& axis,
                      const EdgesMeeting& meeting, const EdgeOfFace& a, const EdgeOfFace& b,
                      double alert) {
  const double thickness = clipping_thickness(pair.size());
  if (!meeting.across || !(axis.inside > thickness)) return false;
  double room = pair.size();
  const auto narrow = [&](const EdgeOfFace& of, double at) {
    const Vec3 crossing = of.edge.from + at * of.edge.along;
    for (size_t k = 0; k < of.sides.size(); ++k) {
      const CollisionShape::Side& side = of.sides[k];
      if (static_cast<int>(k) != of.own)
        room = std::min(room, side.offset - side.outward.dot(crossing));
    }
  };
  narrow(a, axis.at_a);
  narrow(b, axis.at_b);
  const auto slope_of = [](double rise) { return rise / std::sqrt(1.0 + rise * rise); };
  const double slope = std::min(slope_of(meeting.rise_a), slope_of(meeting.rise_b));
  return room > 4.0 * thickness && axis.separation + 0.98 * room * slope > alert + 4.0 * thickness;
}

}  // namespace ballast
