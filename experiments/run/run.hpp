#pragma once
// One run: turns a scene into a folder of results. It can be resumed however it was ended.

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

/// Resolves a scene to be run, by name or path. Throws Error, also where no solver has the name
/// that the scene gives; a known solver may be missing in this build.
ResolvedScene resolve_run(const std::string& scene, const std::vector<std::string>& overrides);

/// Throws MissingSolver where this build lacks a backend of the scene.
void require_backends(const Scene& scene);

struct RunOptions {
  std::string scene;                   ///< name or path
  std::vector<std::string> overrides;  ///< "dotted.key=value"
  std::filesystem::path output;        ///< the run's folder; empty: results/<scene name>
  /// Where deposited packings are kept; empty: <output>/../packings.
  std::filesystem::path packing_cache;
  /// Continues the run in the folder, or begins one; a finished run is left as it is. Without
  /// `resume` an existing run is an error.
  bool resume = false;
  bool overwrite = false;  ///< replace a run found in the folder
  /// Only makes sure that the packing is in the cache; the folder is not touched.
  bool deposit_only = false;
  CaptureSettings capture;  ///< steps to keep as problem files
  int threads = 1;          ///< of a step; their number does not change the results
  /// The shell command that continues this run from any folder; empty: none is printed.
  std::string again;
  double max_seconds = 1e30;  ///< wall clock: checkpoint and exit code 3 after this
  Progress::Style style = StatusLine::style_of_stderr();
};

/// How a run ended.
struct RunEnd {
  ExitCode code = ExitCode::ok;
  std::filesystem::path folder;  ///< of the run
  bool was_finished = false;     ///< it was so before this call: nothing was done
};

/// Runs to the end, to the time limit, or to a signal that InterruptGuard catches (then:
/// checkpoint, ExitCode::failure and a printed line that says how to continue). One process at a
/// time works in a folder: run() throws where another one runs there, and waits for a packing that
/// another run deposits. Throws MissingSolver, Error: each with a one-line what().
///
/// docs/manual/records.md says what the folder then holds, without the page, which write_report()
/// makes (experiments/run_page).
RunEnd run(const RunOptions& options);

/// The start of a run, as its loop needs it.
struct PreparedRun {
  MechanicalSystem system;
  MotionState state;
  StepMemory memory;
  std::optional<ControlVolume> control_volume;  ///< of the vibrated box
};

/// Prepares the start of a run: from the scene alone, or driven from its packing, which is taken as
/// `order` says. Facts about the box that a reader needs are noted in the manifest. Returns false
/// when stopped while depositing. Throws Error.
bool prepare_run(const Scene& scene, const PackingOptions& order, Manifest& manifest,
                 PreparedRun& run);

}  // namespace ballast
