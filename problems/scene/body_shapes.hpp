#pragma once
// The shapes of bodies in a scene file: what [[body]] says of its shape, and [[body.part]] of
// parts.

#include <filesystem>
#include <string>

#include "geometry/shape/compound.hpp"
#include "problems/scene/toml_reader.hpp"

namespace ballast {

/// A shape in its principal frame, as bodies have it.
struct ReadShape : CompoundShape {  // where there are no parts the hull is the shape itself
  bool is_surface = false;          ///< a mesh's faces: for what does not move by itself
  std::string mesh_key;             ///< of the contents of mesh files
};

/// Reads `shape` and the keys of its kind, or the tables `part`. Mesh files are named from
/// `folder`. Throws Error.
ReadShape read_shape(TomlTable& table, const std::filesystem::path& folder);

/// "axis" and "angle_degrees" of a rotation.
Quat read_orientation(TomlTable table);

/// A mesh file's name made absolute: from the scene's folder, not from where the program runs.
std::string mesh_path(const std::filesystem::path& scene_folder, const std::string& name);

/// Throws Error where the vector is zero.
void check_direction(const TomlTable& table, const char* key, const Vec3& v);

}  // namespace ballast
