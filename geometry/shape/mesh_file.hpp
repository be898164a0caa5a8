#pragma once
// OBJ and STL (text and binary), so that a user's own digitised grains run.

#include <filesystem>

#include "geometry/shape/mesh_file_error.hpp"
#include "geometry/shape/polyhedron.hpp"

namespace ballast {

/// Reads a closed convex polyhedron; the format follows the suffix (.obj, .stl). `scale` multiplies
/// coordinates (0.001 for millimetres). STL vertices are welded when they agree to 1e-6 of the
/// size. Coplanar neighbours become one polygon; in binary STL, which is single precision, they are
/// coplanar to 1e-6 of the size. Dents up to that, which single precision and short decimals leave,
/// are closed by taking the hull; deeper ones are errors.
/// Throws MeshFileError.
Polyhedron read_mesh(const std::filesystem::path& file, double scale = 1.0);

/// As read_mesh, but takes the convex hull of the vertices instead of insisting on convexity: for
/// scanned grains.
Polyhedron read_mesh_hull(const std::filesystem::path& file, double scale = 1.0);

}  // namespace ballast
