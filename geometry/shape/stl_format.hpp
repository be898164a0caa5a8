#pragma once
// STL: a soup of triangles, as text or binary (80 bytes of header, count, 50 bytes per triangle,
// little-endian). Normals are passed over: the order of the corners says which side is outside.

#include "geometry/shape/raw_mesh.hpp"

namespace ballast::raw_mesh {

/// Text or binary, told apart by the content. Corners that agree to 1e-6 of the largest extent are
/// welded into one vertex. `file`: for messages only. Throws MeshFileError.
RawMesh read_stl(const std::filesystem::path& file, std::string_view content);

}  // namespace ballast::raw_mesh
