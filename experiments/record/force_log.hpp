#pragma once
// The contact forces of stored frames: a log while a run lives, the group /contacts of record.h5
// when it ends. Only where the scene asks for them (record.forces): they are several times as much
// as the poses.

#include <cstdint>
#include <filesystem>
#include <span>
#include <vector>

#include "experiments/step/step_memory.hpp"
#include "platform/hdf5_file.hpp"
#include "platform/row_log.hpp"
#include "problems/mechanics/mechanical_system.hpp"

namespace ballast {

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

}  // namespace ballast
