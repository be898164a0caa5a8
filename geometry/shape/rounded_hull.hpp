#pragma once
// The solid that was meant by points whose coordinates have been rounded.

#include <span>

#include "geometry/shape/polyhedron.hpp"

namespace ballast {

/// Hull of points that were rounded by about `rounding` of their size, as single precision does:
/// what lies in one plane to that is one face again. The corners are moved, by no more than some
/// roundings, to where the planes of their faces meet. Where nothing can be joined, or no corners
/// fit the joined faces, it is the hull of the points as they are. Throws InvalidPolyhedron as
/// convex_hull does.
Polyhedron rounded_hull(std::span<const Vec3> points, double rounding);
/// The same of points whose hull is there already.
Polyhedron rounded_hull(Polyhedron hull, double rounding);

}  // namespace ballast
