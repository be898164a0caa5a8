#pragma once
// record.h5: all that a run recorded, in one file that explains itself (docs/manual/records.md).
// The file has the attributes format ("ballast record 2"), bits_generation (below), scene (TOML)
// and manifest (JSON), every dataset of numbers the attributes unit and description. /steps, /poses
// and, where record.forces asks for it, /contacts are the layouts below; the tables of /bodies,
// /shapes and /parts are in record_file.cpp.

#include <filesystem>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "experiments/step/step_record.hpp"
#include "platform/hdf5_file.hpp"
#include "platform/row_log.hpp"
#include "problems/mechanics/mechanical_system.hpp"

namespace ballast {

/// One quantity of a log's rows, which becomes one dataset: readers mostly want one quantity over
/// all rows.
struct RowPart {
  std::string name;
  Hdf5Shape shape = {};  ///< of the part; {}: one number
  const char *unit = "", *description = "";
  Hdf5Number number = Hdf5Number::float64;

  size_t size() const;  ///< how many numbers
};

/// What the rows of a log are, and the group of record.h5 that is made of them.
struct RowLayout {
  std::string group;
  std::vector<RowPart> parts;
  size_t leading = 0;  ///< numbers before the first part, which are in the log alone

  size_t row_size() const;
};

/// One row per step; per stored frame; and per contact of a stored frame, which also has step and
/// time in the log: several times as much as the poses.
RowLayout steps_layout();
RowLayout poses_layout(size_t bodies);
RowLayout contacts_layout();

void pack_pose_row(const MotionState& state, std::vector<double>& row);
MotionState unpack_pose_row(std::span<const double> row);

/// The layout's group with a dataset (rows, shape) for each part, its unit and description as
/// attributes. All safe rows of the log are read; no more than a megabyte of them is in memory.
/// `see` is called with each. Throws Error.
void add_rows(Hdf5Writer& file, const std::filesystem::path& log, const RowLayout& layout,
              const std::function<void(std::span<const double> row)>& see = {});

/// From the logs, all of whose rows must be safe. `forces`: empty where none were asked for. Throws
/// Error.
void write_record_file(const std::filesystem::path& file, const MechanicalSystem& system,
                       const std::filesystem::path& steps, const std::filesystem::path& poses,
                       const std::filesystem::path& forces, const std::string& scene_text,
                       const std::string& manifest_text);

std::vector<StepRecord> read_record_steps(const std::filesystem::path& file);
std::vector<MotionState> read_record_poses(const std::filesystem::path& file);

/// Which generation of bits the results belong to: within one, the same scene gives the same bits.
/// Raised by one when a change is meant to give other bits; tests/golden is then made anew.
/// record.h5 names it.
inline constexpr int bits_generation = 15;

/// A contact of a stored frame, for looking at: single precision.
struct FrameContact {
  int body_a = 0, body_b = 0;
  Eigen::Vector3f position, normal;  ///< world frame [m]; from a to b
  Eigen::Vector3f force;             ///< on b, world frame [N]
};

/// The contacts in a record.h5, frame by frame: all of them would be several times the poses.
class RecordForces {
 public:
  /// Throws Error when they do not fit together.
  explicit RecordForces(const std::filesystem::path& record);

  /// Of the record; 0 where it has no contacts at all.
  size_t frame_count() const { return begin_.empty() ? 0 : begin_.size() - 1; }
  /// Those that have a force. Throws Error, also where there is no such frame.
  std::vector<FrameContact> of_frame(size_t frame) const;

 private:
  Hdf5Reader file_;
  std::vector<int> begin_;  // of each frame, and the end
};

/// Bodies, walls and shapes as they were in the run that a record.h5 is of, whatever has become of
/// the files from which its scene had them. The wall with a mass is the driven one; gravity and
/// friction are not in it. Throws Error.
MechanicalSystem read_record_system(const std::filesystem::path& record);

}  // namespace ballast
