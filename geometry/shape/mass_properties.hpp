#pragma once
// Exact mass properties of a closed polyhedron: integrals over tetrahedra, no sampling.

#include "geometry/shape/polyhedron.hpp"

namespace ballast {

/// Per unit density. Inertia is about the centre of mass, in the polyhedron's frame.
struct MassProperties {
  double volume = 0.0;          ///< [m^3]
  Vec3 centre = Vec3::Zero();   ///< centre of mass [m]
  Mat3 inertia = Mat3::Zero();  ///< [m^5] (times density: [kg m^2])
};

MassProperties mass_properties(const Polyhedron& polyhedron);

/// The same solid moved into its body frame: centre of mass at the origin, principal axes along x,
/// y, z.
struct PrincipalShape {
  Polyhedron shape;  ///< vertices in the body frame
  double volume;     ///< [m^3]
  Vec3 inertia;      ///< principal moments per unit density [m^5]
  Pose pose;         ///< body frame in the frame of the polyhedron that was given
};

/// Axes that are principal already (to 1e-12) are kept as they are, so that a box stays an upright
/// box; otherwise the rotation is proper, with moments ascending.
PrincipalShape to_principal_frame(const Polyhedron& polyhedron);

/// Columns: the right-handed principal axes of an inertia, in the frame that it is given in. They
/// are the unit matrix if its axes are principal already; otherwise moments ascend. The choice does
/// not depend on the eigensolver.
Mat3 principal_axes(const Mat3& inertia);

}  // namespace ballast
