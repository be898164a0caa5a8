#pragma once
// Views of what stands still: scenes before their first step, packings, single meshes.

#include <filesystem>

#include "experiments/view/view_data.hpp"
#include "problems/scene/scene.hpp"

namespace ballast {

/// A scene before its first step. One with grains: its packing, where the cache has it, else the
/// rain from which it would be made.
ViewData view_of_scene(const Scene& scene, const std::filesystem::path& packing_cache);

/// One convex body of an OBJ or STL file, in its own frame. Throws MeshFileError.
ViewData view_of_mesh(const std::filesystem::path& file);

}  // namespace ballast
