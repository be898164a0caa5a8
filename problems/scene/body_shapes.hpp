#pragma once
// Reads the shapes of bodies in a scene file: the shape of [[body]], and the parts in
// [[body.part]].

#include <filesystem>
#include <string>

#include "geometry/shape/compound.hpp"
#include "problems/scene/toml_reader.hpp"

namespace ballast {

/// A shape in its principal frame, as bodies have it.
struct ReadShape : CompoundShape {  // without parts the hull is the shape itself
  bool is_surface = false;          ///< a mesh's faces: only for bodies without freedom
  std::string mesh_key;             ///< hash of the contents of mesh files
};

/// Reads `shape` and the keys of its kind, or the tables `part`. Paths of mesh files start at
/// `folder`. Throws Error.
ReadShape read_shape(TomlTable& table, const std::filesystem::path& folder);

/// Reads "axis" and "angle_degrees" of a rotation.
Quat read_orientation(TomlTable table);

/// Makes a mesh file's name absolute: from the scene's folder, not from the working directory.
std::string mesh_path(const std::filesystem::path& scene_folder, const std::string& name);

/// Throws Error where the vector is zero.
void check_direction(const TomlTable& table, const char* key, const Vec3& v);

}  // namespace ballast
