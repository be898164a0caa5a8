#pragma once
// A plan: named runs of scenes. The seam between who asks for runs (a plan's file, a figure of the
// paper) and who sees to it that they are there. A run is known by its content: two figures that
// ask for the same run share it.

#include <filesystem>
#include <string>
#include <vector>

namespace ballast {

struct PlannedRun {
  std::string name;                    ///< unique in its plan: letters, digits, _ - . =
  std::string scene;                   ///< name or path, as for `ballast run`
  std::vector<std::string> overrides;  ///< "dotted.key=value"
};

struct Plan {
  std::string name;  ///< as a run's; also a file's
  std::vector<PlannedRun> runs;
};

/// Reads a plan file (docs/manual/plans.md). Throws SceneFileError naming file, key and value: also
/// for a run that is not a valid scene.
Plan read_plan(const std::filesystem::path& file);

/// The plan as a file that read_plan reads to the same plan: every run written out. Throws Error
/// when it cannot be written.
void write_plan(const Plan& plan, const std::filesystem::path& file);

/// Key of the resolved scene: the same for runs that compute the same. Throws SceneFileError.
std::string run_key(const PlannedRun& run);

/// The runs of the plan that a shell's pattern names; all of them where it is empty. Throws
/// SceneFileError when there are none.
std::vector<PlannedRun> select(const Plan& plan, const std::string& pattern);

}  // namespace ballast
