#pragma once
// Reads OBJ and STL files (text and binary), so that users can run their own digitised grains.

#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

#include "geometry/shape/polyhedron.hpp"
#include "platform/error.hpp"

namespace ballast {

/// A mesh file that cannot be read. what() is one line: the file's name, the line or the face, and
/// the defect.
class MeshFileError : public Error {
 public:
  using Error::Error;
};

/// Solids with more vertices are refused: detection compares all faces with all vertices once.
inline constexpr size_t most_mesh_vertices = 10000;

/// Decides by the suffix, .obj or .stl, in capital or small letters.
bool is_mesh_file(const std::filesystem::path& file);

/// Reads a closed convex polyhedron; the format follows the suffix (.obj, .stl). `scale` multiplies
/// coordinates (0.001 for millimetres). STL vertices are welded when they agree to 1e-6 of the
/// size. Coplanar neighbours become one polygon; in binary STL, which is single precision, they are
/// coplanar to 1e-6 of the size. Dents up to that, which single precision and short decimals leave,
/// are closed by taking the hull (rounded_hull); deeper ones are errors. Throws MeshFileError.
Polyhedron read_mesh(const std::filesystem::path& file, double scale = 1.0);

/// As read_mesh, but takes the convex hull of the vertices instead of insisting on convexity: for
/// scanned grains.
Polyhedron read_mesh_hull(const std::filesystem::path& file, double scale = 1.0);

/// Reads the faces of a mesh as they stand, corner by corner [m]; they need not be closed or
/// convex. Throws MeshFileError.
std::vector<std::vector<Vec3>> read_faces(const std::filesystem::path& file, double scale = 1.0);

/// A text key of a mesh's vertices and faces, exact to the last bit.
std::string mesh_key(const Polyhedron& mesh);

}  // namespace ballast
