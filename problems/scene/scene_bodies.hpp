#pragma once
// Reads walls, bodies, their copies and crowds of a scene file: [[wall]], [[body]], [[crowd]] and
// [[contact.pair]].

#include <filesystem>
#include <vector>

#include "problems/algebra/friction_problem.hpp"
#include "problems/scene/body_shapes.hpp"
#include "problems/scene/scene.hpp"

namespace ballast {

/// The range of every friction coefficient; the largest holds as a bond would.
inline constexpr NumberRange friction_range{"a number from 0 to 1e4", 0.0, largest_friction, true,
                                            true};

/// Reads the walls, then the bodies, then the crowds into the scene, whose period is known. Names
/// are unique among all; unnamed ones are called wall_0, body_0, crowd_0, ... Throws Error.
void read_bodies(TomlTable& root, const std::filesystem::path& folder, Scene& scene);

/// Reads the laws between the materials of the bodies that were read. Throws Error.
void read_material_pairs(const std::vector<TomlTable>& tables, Scene& scene);

}  // namespace ballast
