#pragma once
// Wavefront OBJ: the statements v and f; texture, normals, groups and materials are passed over.

#include "geometry/shape/raw_mesh.hpp"

namespace ballast::raw_mesh {

/// `file`: for messages only. Throws MeshFileError on unknown statements, bad numbers and faces
/// that name a vertex that is not there.
RawMesh read_obj(const std::filesystem::path& file, std::string_view text);

}  // namespace ballast::raw_mesh
