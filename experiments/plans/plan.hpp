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

/// Throws SceneFileError "<origin>: ..." when a name cannot be one or stands twice, or a run is no
/// valid scene.
void validate(const Plan& plan, const std::string& origin);

/// Key of the resolved scene: the same for runs that compute the same. Throws SceneFileError.
std::string run_key(const PlannedRun& run);

/// Where the run's results are: <results>/runs/<key>. Its packing: <results>/packings.
std::filesystem::path folder_of(const std::filesystem::path& results, const PlannedRun& run);

/// Finished: every step is there and the records are closed.
bool is_finished(const std::filesystem::path& results, const PlannedRun& run);

}  // namespace ballast
