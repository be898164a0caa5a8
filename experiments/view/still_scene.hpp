#pragma once
// Views of what stands still: scenes before their first step, packings, single meshes.

#include <filesystem>
#include <vector>

#include "experiments/view/view_data.hpp"
#include "problems/scene/scene.hpp"

namespace ballast {

/// A scene before its first step. One with grains: its packing, where the cache has it, else the
/// rain from which it would be made.
ViewData view_of_scene(const Scene& scene, const std::filesystem::path& packing_cache);

/// Whether a file has the name of a kept packing.
bool is_packing_file(const std::filesystem::path& file);
/// A packing as it lies, with the forces that hold it. Its file has no shapes: `scenes` are tried
/// for the one that makes it. Throws Error: none of them, or a broken file.
ViewData view_of_packing(const std::filesystem::path& file, const std::vector<Scene>& scenes);
/// The program's own scenes, and those of the runs in the folder where the packings' folder is.
std::vector<Scene> scenes_around(const std::filesystem::path& packing);

/// One convex body of an OBJ or STL file, in its own frame. Throws MeshFileError.
ViewData view_of_mesh(const std::filesystem::path& file);

}  // namespace ballast
