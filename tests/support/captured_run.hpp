#pragma once
// A small run with captured problems, for tests of the pages and files that show them.

#include "experiments/run/run.hpp"
#include "problems/files/captured_problem.hpp"
#include "tests/catch.hpp"

namespace ballast {

/// Runs ten boxes at rest into `folder` and captures some steps. Returns one of the captured files,
/// which lie in folder/capture.
inline std::filesystem::path captured_run(const std::filesystem::path& folder) {
  RunOptions options;
  options.scene = "settled_rest";
  options.overrides = {"scene.duration=0.01"};
  options.output = folder;
  options.capture = CaptureSettings::parse("every=5");
  run(options);
  std::filesystem::path file;
  for (const auto& entry : std::filesystem::directory_iterator(folder / "capture"))
    if (is_captured(entry.path())) file = entry.path();
  REQUIRE_FALSE(file.empty());
  return file;
}

}  // namespace ballast
