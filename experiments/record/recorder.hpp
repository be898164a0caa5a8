#pragma once
// The record of a run: append-only raw logs while it lives, one HDF5 file and one CSV when it ends.

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "experiments/record/record_file.hpp"

namespace ballast {

/// Rows are appended to log/steps.bin (fixed size, one per step), log/poses.bin (fixed size, one
/// per stored frame) and, if asked for, log/forces.bin (one per contact of a stored frame), so that
/// a killed run loses at most what came after its last checkpoint, and a resumed one cuts them back
/// to it.
class Recorder {
 public:
  /// Opens or creates the logs in `folder`. Rows with step > `last_step` are cut off (0: start
  /// afresh, without any row, so that the frame of step 0 is added again). A steps.csv and
  /// record.h5 of before are removed: they would not be this run's. `system` must outlive the
  /// recorder. Throws Error naming the file: unwritable, shorter than last_step says, damaged, of
  /// another system or other columns.
  Recorder(const std::filesystem::path& folder, const MechanicalSystem& system, long last_step,
           bool with_forces = false);

  /// One call per step: row k is step k + 1.
  void add_step(const StepRecord& row);
  /// A stored frame and, where forces are asked for, its contacts with the impulses of its step
  /// [N s], which is `h` long [s].
  void add_frame(const MotionState& state, const StepMemory& memory, double h);
  /// Everything so far on disk (fflush + fsync): called before a checkpoint is written. Throws
  /// Error, for instance on a full disk.
  void flush();
  /// steps.csv and record.h5 from the logs, each written beside and renamed. The two texts are kept
  /// in record.h5.
  void finish(const std::string& scene_text, const std::string& manifest_text);

 private:
  std::filesystem::path folder_;
  const MechanicalSystem& system_;
  std::optional<RowWriter> steps_, poses_, forces_;
  std::vector<double> row_;
};

/// Reads back what a recorder wrote: record.h5, or where there is none the raw logs of a run still
/// going. Throws Error.
std::vector<StepRecord> read_steps(const std::filesystem::path& folder);
std::vector<MotionState> read_poses(const std::filesystem::path& folder);

/// Throws Error where the folder's log was begun with other bodies than these: a mesh file that the
/// scene names has changed meanwhile. Without a log there is nothing to compare.
void require_same_bodies(const std::filesystem::path& folder, const MechanicalSystem& system);

}  // namespace ballast
