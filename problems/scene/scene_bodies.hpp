#pragma once
// The [[wall]] and [[body]] tables of a scene.

#include <filesystem>
#include <vector>

#include "problems/scene/scene.hpp"
#include "problems/scene/toml_reader.hpp"

namespace ballast {

/// Names are unique among walls and bodies; unnamed ones are called wall_0, body_0, ... Throws
/// SceneFileError.
std::vector<WallSpec> read_walls(TomlTable& root);
std::vector<BodySpec> read_bodies(TomlTable& root, const std::filesystem::path& scene_folder,
                                  const std::vector<WallSpec>& walls);

/// A mesh file's name made absolute: from the scene's folder, not from where the program runs.
std::string mesh_path(const std::filesystem::path& scene_folder, const std::string& name);

}  // namespace ballast
