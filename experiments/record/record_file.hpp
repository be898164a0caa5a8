#pragma once
// record.h5: all that a run recorded, in one file that explains itself.
//
//   /                attributes format ("ballast record 2"), bits_generation (below),
//                    scene (TOML), manifest (JSON)
//   /steps/<column>  (steps): one dataset for each column of step_columns()
//   /poses/time, step                 (frames)
//   /poses/position, velocity, spin   (frames, bodies, 3): world frame; spin in the body frame
//   /poses/rotation                   (frames, bodies, 4): body to world, w x y z
//   /bodies/name, mass, volume        (bodies)
//   /bodies/inertia                   (bodies, 3)
//   /bodies/shape                     (bodies): number of the shape, -1 for a wall
//   /bodies/wall_normal               (bodies, 3): into the free side; 0 for grains
//   /shapes/vertices                  (all shapes' n, 3): in the body frame
//   /shapes/triangles                 (m, 3): vertex numbers within the shape, counter-clockwise
//                                     from outside
//   /shapes/vertex_begin, triangle_begin   (shapes + 1): where shape k begins and ends
//
//   /contacts/...                     contact forces of the frames, where record.forces asks for
//                                     them
//
// Every dataset of numbers has the attributes unit and description.

#include <cstdint>
#include <filesystem>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "experiments/step/step_memory.hpp"
#include "experiments/step/step_record.hpp"
#include "geometry/shape/pose.hpp"
#include "platform/hdf5_file.hpp"
#include "platform/row_log.hpp"
#include "problems/mechanics/mechanical_system.hpp"

namespace ballast {

/// One stored frame.
struct PoseFrame {
  double time = 0.0;
  long step = 0;
  std::vector<Pose> pose;
  std::vector<Vec3> velocity, spin;  ///< world frame, body frame
};

/// One frame as a row of a log: step, time, then positions, rotations (w x y z), velocities and
/// spins of all bodies.
size_t pose_row_size(size_t bodies);
void pack_pose_row(const MotionState& state, std::vector<double>& row);
PoseFrame unpack_pose_row(std::span<const double> row);

/// The logs are read from their first row; all their rows must be safe. `forces`: null where none
/// were asked for. Throws Error.
void write_record_file(const std::filesystem::path& file, const MechanicalSystem& system,
                       RowReader& steps, RowReader& poses, RowReader* forces,
                       const std::string& scene_text, const std::string& manifest_text);

std::vector<StepRecord> read_record_steps(const std::filesystem::path& file);
std::vector<PoseFrame> read_record_poses(const std::filesystem::path& file);

/// Which generation of bits the results belong to: within one, the same scene gives the same bits.
/// Raised by one when a change is meant to give other bits; tests/golden is then made anew.
/// record.h5 names it.
inline constexpr int bits_generation = 9;

// From a log of rows, which a run that may be killed writes, to datasets of the finished record.

/// The same numbers of every row, which become one dataset: readers mostly want one quantity over
/// all rows.
struct RowPart {
  std::string dataset;
  size_t begin = 0;      ///< first of the numbers in a row
  Hdf5Shape shape = {};  ///< of the part; {}: one number
  const char *unit = "", *description = "";
  Hdf5Number number = Hdf5Number::float64;
};

/// Adds a dataset (rows, shape) for each part, with its unit and description as attributes. All
/// safe rows are read, from the first; no more than a megabyte of them is in memory. `see` is
/// called with each. Throws Error.
void add_row_parts(Hdf5Writer& file, RowReader& rows, std::span<const RowPart> parts,
                   const std::function<void(std::span<const double> row)>& see = {});

// The contact forces of stored frames: a log while a run lives, the group /contacts of record.h5
// when it ends. Only where the scene asks for them (record.forces): they are several times as much
// as the poses.

/// One contact of one frame as a row of the log: step, time, bodies a and b, position, normal, gap,
/// force on b.
inline constexpr size_t force_row_size = 14;

/// `h`: the step's length, by which an impulse is a force [s].
void pack_force_row(const MotionState& state, const ContactPoint& contact, const Vec3& impulse,
                    double h, std::vector<double>& row);

/// The group /contacts: the rows of the log frame by frame. `frame_steps`: the steps of the stored
/// frames in their order; a frame may have no contact. Throws Error.
void add_forces(Hdf5Writer& file, RowReader& rows, std::span<const std::int64_t> frame_steps);

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
/// the files from which its scene had them. Gravity and friction are not in it. Throws Error.
MechanicalSystem read_record_system(const std::filesystem::path& record);

}  // namespace ballast
