#pragma once
// One run: a scene to a folder of results, resumable after any kind of death.

#include <filesystem>
#include <stdexcept>
#include <string>
#include <vector>

#include "problems/mechanics/mechanical_system.hpp"

namespace ballast {

/// Exit codes of the ballast program.
enum class ExitCode { ok = 0, failure = 1, usage = 2, time_limit = 3, backend_missing = 4 };

struct RunOptions {
  std::string scene;                   ///< name or path
  std::vector<std::string> overrides;  ///< "dotted.key=value"
  std::filesystem::path output;        ///< the run's folder; empty: results/<scene name>
  std::filesystem::path packing_cache; ///< where deposited packings are kept; empty: <output>/../packings
  bool resume = false;                 ///< continue the run found in the folder; without it an existing run is an error
  bool begin_or_resume = false;        ///< continue the run found in the folder, or begin one; a finished one is left as it is
  bool deposit_only = false;           ///< only see to it that the packing is in the cache; the folder is not touched
  bool overwrite = false;              ///< replace a run found in the folder
  bool new_packing = false;            ///< deposit again even if the cache has the packing
  std::string capture;                 ///< which steps to keep as problem files (CaptureSettings::parse); empty: none
  int threads = 1;                     ///< of the solver; the results are the same whatever their number
  bool report = true;                  ///< figures and page at the end
  double max_seconds = 1e30;           ///< wall clock: checkpoint and exit code 3 after this
};

/// Runs to the end, to the time limit, or to SIGINT/SIGTERM (checkpoint, then ExitCode::failure with the line that resumes).
/// A folder is one process's at a time: another one that runs there throws, and a packing that another run deposits is waited for.
/// Throws SceneFileError, InvalidProblem, MissingSolver, UnknownSolver, RunError: each with a one-line what().
///
/// The folder then holds: scene.toml (resolved), manifest.json, steps.csv, record.h5, checkpoint.bin, capture/ (if asked for), log/ (append-only raw
/// rows from which the two records are made), figures/*.svg, report.html.
ExitCode run(const RunOptions& options);

/// The system of a run's folder, rebuilt from its scene.toml and packing, with its latest checkpointed state. Throws RunError.
MechanicalSystem system_of_run(const std::filesystem::path& folder, MotionState& state);

class RunError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

}  // namespace ballast
