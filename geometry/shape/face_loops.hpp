#pragma once
// Faces as loops of point indices, and the solid that they bound.

#include <span>
#include <vector>

#include "geometry/shape/polyhedron.hpp"

namespace ballast {

/// Faces as closed loops of point indices.
using Loops = std::vector<std::vector<int>>;

/// Loops of a convex solid put in one order, whoever listed them: outward, each from its smallest
/// index, in ascending order.
void make_canonical(Loops& loops, std::span<const Vec3> points);

/// The solid of these loops, outward; its vertices keep the order of the points, without those of
/// no loop. Throws InvalidPolyhedron as Polyhedron's constructor.
Polyhedron solid_of(std::span<const Vec3> points, Loops loops);

}  // namespace ballast
