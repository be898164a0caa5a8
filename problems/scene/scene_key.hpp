#pragma once
// Keys of what a result depends on: of a scene, and of the user's meshes in it.

#include <string>

#include "problems/scene/scene.hpp"

namespace ballast {

/// Of a polyhedron's vertices and faces, to the last bit.
std::string mesh_key(const Polyhedron& mesh);

/// Of everything that a run of the scene computes from: its resolved text, and what is in the mesh
/// files that the text only names.
std::string scene_key(const Scene& scene, const std::string& resolved_text);

}  // namespace ballast
