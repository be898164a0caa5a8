#pragma once
// Common to several tests of scenes: a text to begin with, and the error of a wrong text.

#include "problems/scene/scene_file.hpp"
#include "tests/catch.hpp"
#include "tests/support/complaint.hpp"
#include "tests/support/temporary_folder.hpp"

namespace ballast {

/// The shortest scene: a wall.
inline const std::string one_wall = "[[wall]]\nnormal = [0, 0, 1]\n";

/// The message of the error, in one line, with which reading the text must end.
inline std::string error_of(const TemporaryFolder& folder, const std::string& text,
                            const std::vector<std::string>& overrides = {}) {
  const std::string message =
      complaint<Error>([&] { read_scene(folder.write("scene.toml", text), overrides); });
  INFO(text);
  CHECK_THAT(message, Catch::StartsWith((folder.path() / "scene.toml").string()));
  CHECK(message.find('\n') == std::string::npos);
  return message;
}

}  // namespace ballast
