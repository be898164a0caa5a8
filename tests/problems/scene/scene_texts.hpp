#pragma once
// What several tests of scenes share: a text to begin with, and the error of a wrong one.

#include "problems/scene/scene_file.hpp"
#include "tests/catch.hpp"
#include "tests/support/complaint.hpp"
#include "tests/support/temporary_folder.hpp"

namespace ballast {

/// A wall is enough to be a scene.
inline const std::string one_wall = "[[wall]]\nnormal = [0, 0, 1]\n";

/// The message of the error, in one line, that reading the text must end in.
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
