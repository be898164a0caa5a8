#include "geometry/shape/compound.hpp"

#include <numeric>

#include "geometry/shape/convex_hull.hpp"

namespace ballast {

CompoundShape make_compound(std::span<const PlacedShape> parts) {
  if (parts.empty()) throw InvalidPolyhedron("a body of no parts");
  CompoundShape compound;
  std::vector<PrincipalShape> solids;
  std::vector<Pose> places;  // of the solids' principal frames, in the given frame
  Vec3 first = Vec3::Zero();
  for (const PlacedShape& part : parts) {
    const PrincipalShape& solid = solids.emplace_back(to_principal_frame(*part.shape));
    places.push_back({part.pose * solid.pose.position, part.pose.rotation * solid.pose.rotation});
    compound.volume += solid.volume;
    first += solid.volume * places.back().position;
  }
  const Vec3 centre = first / compound.volume;
  // Steiner's theorem takes each part's inertia to the common centre of mass.
  Mat3 inertia = Mat3::Zero();
  for (size_t k = 0; k < parts.size(); ++k) {
    const Mat3 turned = places[k].rotation.toRotationMatrix();
    const Vec3 arm = places[k].position - centre;
    inertia += turned * solids[k].inertia.asDiagonal() * turned.transpose() +
               solids[k].volume * (arm.squaredNorm() * Mat3::Identity() - arm * arm.transpose());
  }
  const Mat3 axes = principal_axes(inertia);
  compound.inertia = (axes.transpose() * inertia * axes).diagonal();
  compound.pose = {centre, Quat(axes).normalized()};
  const Quat back = compound.pose.rotation.conjugate();
  std::vector<Vec3> corners;
  for (const PlacedShape& part : parts) {
    compound.parts.push_back(
        {part.shape,
         {back * (part.pose.position - centre), (back * part.pose.rotation).normalized()}});
    for (const Vec3& corner : part.shape->vertices())
      corners.push_back(compound.parts.back().pose * corner);
  }
  compound.hull = std::make_shared<const Polyhedron>(convex_hull(corners));
  return compound;
}

Polyhedron thick_polygon(std::span<const Vec3> corners, double thickness) {
  std::vector<int> loop(corners.size());
  std::iota(loop.begin(), loop.end(), 0);
  const Vec3 area = corners.size() < 3 ? Vec3(Vec3::Zero()) : area_vector(loop, corners);
  if (!(area.norm() > 0.0)) throw InvalidPolyhedron("a face without area");
  std::vector<Vec3> points(corners.begin(), corners.end());
  for (const Vec3& corner : corners) points.push_back(corner - thickness * area.normalized());
  Polyhedron solid = convex_hull(points);
  if (solid.vertex_count() != static_cast<int>(points.size()) ||
      solid.face_count() != static_cast<int>(corners.size()) + 2)
    throw InvalidPolyhedron("a face that is no flat, strictly convex polygon");
  return solid;
}

}  // namespace ballast
