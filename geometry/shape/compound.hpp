#pragma once
// Combines placed convex solids into a body with one body frame; makes walls from meshes' faces.

#include <memory>
#include <span>
#include <vector>

#include "geometry/shape/mass_properties.hpp"

namespace ballast {

/// A solid with its place in some frame.
struct PlacedShape {
  std::shared_ptr<const Polyhedron> shape;
  Pose pose;
};

/// Several solids as one rigid body, in its body frame: centre of mass at the origin, principal
/// axes along x, y, z.
struct CompoundShape {
  std::shared_ptr<const Polyhedron> hull;  ///< of all parts
  std::vector<PlacedShape> parts;
  double volume = 0.0;          ///< [m^3]
  Vec3 inertia = Vec3::Zero();  ///< principal moments per unit density [m^5]
  Pose pose;                    ///< body frame in the frame that the parts were given in
};

/// Where parts overlap, both count. Throws InvalidPolyhedron if there is no part.
CompoundShape make_compound(std::span<const PlacedShape> parts);

/// The solid between a flat, strictly convex polygon and its copy `thickness` [m] behind it,
/// against its normal (right-handed about the loop). Throws InvalidPolyhedron.
Polyhedron thick_polygon(std::span<const Vec3> corners, double thickness);

}  // namespace ballast
