#pragma once
// One run: a scene to a folder of results, resumable after any kind of death.

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "experiments/box/packing.hpp"
#include "experiments/run/capture.hpp"
#include "experiments/run/run_folder.hpp"
#include "platform/error.hpp"
#include "problems/scene/scene_file.hpp"

namespace ballast {

/// A scene that is to be run, by name or path. Throws Error, also where no solver has the
/// name that stands in it; a known one may be missing in this build.
ResolvedScene resolve_run(const std::string& scene, const std::vector<std::string>& overrides);

struct RunOptions {
  std::string scene;                   ///< name or path
  std::vector<std::string> overrides;  ///< "dotted.key=value"
  std::filesystem::path output;        ///< the run's folder; empty: results/<scene name>
  /// Where deposited packings are kept; empty: <output>/../packings.
  std::filesystem::path packing_cache;
  /// Continues the run found in the folder, or begins one; a finished one is left as it is. Without
  /// it an existing run is an error.
  bool resume = false;
  bool overwrite = false;  ///< replace a run found in the folder
  /// Only see to it that the packing is in the cache; the folder is not touched.
  bool deposit_only = false;
  CaptureSettings capture;  ///< steps to keep as problem files
  int threads = 1;          ///< of a step; the results are the same whatever their number
  /// The command that goes on with this run, for a shell in any folder; empty: none is told.
  std::string again;
  double max_seconds = 1e30;  ///< wall clock: checkpoint and exit code 3 after this
  Progress::Style style = StatusLine::style_of_stderr();
};

/// How a run ended.
struct RunEnd {
  ExitCode code = ExitCode::ok;
  std::filesystem::path folder;  ///< of the run
  bool was_finished = false;     ///< all of its steps were there before: nothing was done
};

/// Runs to the end, to the time limit, or to a signal that InterruptGuard catches (checkpoint, then
/// ExitCode::failure with the line that goes on). A folder is one process's at a time: another one
/// that runs there throws, and a packing that another run deposits is waited for. Throws
/// MissingSolver, Error: each with a one-line what().
///
/// The folder then holds: scene.toml (resolved), manifest.json, steps.csv, record.h5,
/// checkpoint.bin, capture/ and states/ (if asked for), log/ (raw rows from which the two records
/// are made). Its page is write_report()'s (experiments/run_page).
RunEnd run(const RunOptions& options);

/// A run before its first step, as its loop needs it.
struct PreparedRun {
  MechanicalSystem system;
  MotionState state;
  StepMemory memory;
  std::optional<ControlVolume> control_volume;  ///< of the vibrated box
};

/// The start of the scene: as it says, or driven from its packing, which `order` says where to
/// find. What a reader wants to know of the box is noted in the manifest. False: stopped while
/// depositing. Throws Error.
bool prepare_run(const Scene& scene, const PackingOrder& order, Manifest& manifest,
                 PreparedRun& run);

}  // namespace ballast
