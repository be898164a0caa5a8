#pragma once
// Texts of scenes that several tests of the room begin with.

#include <string>

namespace ballast {

/// A wall is enough to be a scene.
inline const std::string one_wall = "[[wall]]\nnormal = [0, 0, 1]\n";

}  // namespace ballast
