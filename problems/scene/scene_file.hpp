#pragma once
// Scenes in TOML, validated: an error names file, key and value.

#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "problems/scene/scene.hpp"

namespace ballast {

/// Reads and validates a scene; every key must be known, of its type and in its range. `overrides`:
/// "dotted.key=value" with a TOML value, applied before validation (command line --set). Mesh files
/// are relative to the scene file.
Scene read_scene(const std::filesystem::path& file, std::span<const std::string> overrides = {});

/// A scene with the text and the key that identify it.
struct ResolvedScene {
  Scene scene;
  std::string text;  ///< merged and validated TOML (file plus overrides): sorted keys, 17 digits
  std::string key;   ///< hash of all input of a run: the text, and the mesh files' content
};
ResolvedScene resolve_scene(const std::filesystem::path& file,
                            std::span<const std::string> overrides = {});

/// Reads contact.friction of a scene, whose mesh files may be missing.
double scene_friction(const std::filesystem::path& file);

/// A scene given by name ("vibrated_box") or path; names are looked up in the scene folder of the
/// installation (see scene_folder()). Throws Error that lists the known names.
std::filesystem::path find_scene(const std::string& name_or_path);
std::filesystem::path scene_folder();
/// Name and title of every scene in the folder, sorted. A file that is not valid TOML is left out,
/// and its error is added to `unreadable`.
std::vector<std::pair<std::string, std::string>> list_scenes(std::string* unreadable = nullptr);

}  // namespace ballast
