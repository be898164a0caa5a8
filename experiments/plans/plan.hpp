#pragma once
// A plan: named runs of scenes. It is the seam between the code that asks for runs (a plan's file,
// a figure of the paper) and the code that makes them. A run is identified by its content: two
// figures that ask for the same run share it.

#include <filesystem>
#include <string>
#include <vector>

namespace ballast {

struct PlannedRun {
  std::string name;                    ///< unique in its plan: letters, digits, _ - . =
  std::string scene;                   ///< name or path, as for `ballast run`
  std::vector<std::string> overrides;  ///< "dotted.key=value"
  // known once its scene has been read
  std::string key{};          ///< of the resolved scene: the same for runs that compute the same
  std::string packing{};      ///< packing_key of its scene; empty: it has none
  long steps = 0;             ///< of the drive
  double work = 0.0;          ///< bodies times steps: its time is roughly proportional to it
  double packing_work = 0.0;  ///< the same of the deposit, as far as it is known beforehand
};

/// Makes a run, for which it reads the scene. Throws Error.
PlannedRun planned_run(const std::string& name, const std::string& scene,
                       const std::vector<std::string>& overrides);

struct Plan {
  std::string name;  ///< spelt like a run's; also names a folder
  std::vector<PlannedRun> runs;
};

/// Reads a plan file (docs/manual/plans.md). Throws Error naming file, key and value: also
/// for a run that is not a valid scene.
Plan read_plan(const std::filesystem::path& file);
/// The same for a text that was read from `file`.
Plan plan_of(const std::string& toml, const std::filesystem::path& file);

/// The runs of the plan whose names match a shell pattern; all runs where it is empty. Throws Error
/// when there are none.
std::vector<PlannedRun> select(const Plan& plan, const std::string& pattern);

}  // namespace ballast
