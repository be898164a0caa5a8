#pragma once
// Reads walls, bodies, their shapes and copies, and crowds of a scene file: [[wall]], [[body]],
// [[body.part]], [[crowd]] and [[contact.pair]].

#include <filesystem>
#include <string>
#include <vector>

#include "problems/algebra/friction_problem.hpp"
#include "problems/scene/scene.hpp"
#include "problems/scene/toml_reader.hpp"

namespace ballast {

/// The range of every friction coefficient; the largest holds as a bond would.
inline constexpr NumberRange friction_range{"a number from 0 to 1e4", 0.0, largest_friction, true,
                                            true};

/// Reads the walls, then the bodies, then the crowds into the scene, whose period is known. Names
/// are unique among all; unnamed ones are called wall_0, body_0, crowd_0, ... Throws Error.
void read_bodies(TomlTable& root, const std::filesystem::path& folder, Scene& scene);

/// Reads the laws between the materials of the bodies that were read. Throws Error.
void read_material_pairs(const std::vector<TomlTable>& tables, Scene& scene);

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
