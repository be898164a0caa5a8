#pragma once
// The record of a run: append-only raw logs while it runs, one HDF5 file and one CSV when it ends.

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "experiments/record/record_file.hpp"

namespace ballast {

/// Rows are appended to log/steps.bin (fixed size, one per step), log/poses.bin (fixed size, one
/// per stored frame) and, if asked for, log/forces.bin (one per contact of a stored frame). A
/// killed run loses at most the rows after its last checkpoint; a resumed one cuts the logs back to
/// it.
class Recorder {
 public:
  /// Opens or creates the logs in `folder`. Rows with step > `last_step` are cut off (0: start
  /// afresh, without any row, so that the frame of step 0 is added again). An earlier steps.csv and
  /// record.h5 are removed because they do not describe this run. `system` must outlive the
  /// recorder. Throws Error naming the file: unwritable, shorter than last_step says, damaged, of
  /// another system or with other columns.
  Recorder(const std::filesystem::path& folder, const MechanicalSystem& system, long last_step,
           bool with_forces = false);

  /// To be called once per step: row k is step k + 1.
  void add_step(const StepRecord& row);
  /// Adds a frame and, where forces are asked for, its contacts, whose forces are the impulses of
  /// the step [N s] over its length `h` [s].
  void add_frame(const MotionState& state, const StepMemory& memory, double h);
  /// Makes all rows safe on disk (fflush + fsync). To be called before a checkpoint is written.
  /// Throws Error, for instance on a full disk.
  void flush();
  /// Makes steps.csv and record.h5 from the logs; each is written beside its target and renamed.
  /// The two texts are stored in record.h5.
  void finish(const std::string& scene_text, const std::string& manifest_text);

 private:
  std::filesystem::path folder_;
  const MechanicalSystem& system_;
  std::optional<RowWriter> steps_, poses_, forces_;
  std::vector<double> row_;
};

/// The steps and the frames that a recorder wrote, from record.h5 or, where there is none, from the
/// raw logs of an unfinished run. Throws Error.
std::vector<StepRecord> read_steps(const std::filesystem::path& folder);
std::vector<MotionState> read_poses(const std::filesystem::path& folder);

/// Throws Error where the log of the folder was begun with other bodies: a mesh file that the scene
/// names has changed since. Without a log nothing is compared.
void require_same_bodies(const std::filesystem::path& folder, const MechanicalSystem& system);

}  // namespace ballast
