#pragma once
// A collection of captured problems that everybody can make: the same runs on every machine, and a
// manifest of what is in each file.

#include <filesystem>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "platform/error.hpp"

namespace ballast {

/// One run of vibrated_box, of which four steps are kept: one while the grains still settle, three
/// under the wall's drive.
struct CollectedRun {
  std::string name;  ///< "shaken-80": the scene and the number of grains
  std::vector<std::string> overrides;
};

/// Three scenes for each of six numbers of grains up to `most_grains`, 25 to 2400 (some 60 to 10000
/// contacts): shaken (20 Hz: in and out), pressed (a constant load and much friction: passive),
/// released (the wall gives way, little friction: active). The scenes of a size share their
/// packing, whose grains have just fallen.
std::vector<CollectedRun> collection_runs(int most_grains);

/// Makes what is missing of `folder`: packings/, runs/<name>, problems/<name>/step_*.hdf5 and
/// problems/manifest.csv, a line for each file: content (CaseFacts::content), contacts, rows, step,
/// and the phase: "settling", then that of the driven wall. `told` is called before each run. The
/// code is that of the first run that did not come to its end, of which nothing is lost. Throws
/// Error.
ExitCode make_collection(const std::filesystem::path& folder, std::span<const CollectedRun> runs,
                         const std::function<void(const CollectedRun&)>& told);

}  // namespace ballast
