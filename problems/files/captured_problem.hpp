#pragma once
// A friction problem captured from a run: a standard FCLIB file with the additional group /ballast
// for data that the format has no place for.
//
//   h, g, time, wall_x, wall_v, load           one double each [s] [m/s^2] [s] [m] [m/s] [N]
//   step, phase                                one int; one text
//   dof_begin, body_a, body_b, rows, v_free    the dynamics form as it was (see DynamicsForm)
//   start, solution                            stacked impulses, rows as in the problem [N s]
//   gap, frame, position                       per contact 1, 9 (rows N, T1, T2) and 3, world frame
//   key, id_a, id_b                            feature key (64 bit); bodies by place in the scene

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "problems/algebra/friction_problem.hpp"

namespace ballast {

struct CapturedProblem {
  FrictionProblem problem;  ///< dynamics form, one-row contacts included
  Impulses start;           ///< the warm start, carried over from the step before
  Impulses solution;        ///< returned by the run's solver, at the run's tolerance

  double h = 0.0;                                 ///< [s]
  double g = 0.0;                                 ///< |gravity| [m/s^2]; 0 without
  int step = 0;                                   ///< of the run, counted from 1
  double time = 0.0;                              ///< end of the step [s]
  std::string phase;                              ///< of the wall: none, jammed, active, passive
  double wall_x = 0.0, wall_v = 0.0, load = 0.0;  ///< of the driven wall, as in the run's record

  std::vector<double> gap;         ///< per contact [m]; negative: overlap
  std::vector<double> frame;       ///< 9 per contact: N, T1, T2 in the world frame
  std::vector<double> position;    ///< 3 per contact, world frame [m]
  std::vector<std::uint64_t> key;  ///< names the touching features; stays while they touch
  std::vector<int> id_a, id_b;     ///< bodies of the scene, walls included

  /// The velocity that errors are relative to: g h, or 1 m/s without gravity.
  double velocity_scale() const { return g > 0.0 ? g * h : 1.0; }
};

/// Calls each(name, member) for the data of the step, member by member; for a list each() also gets
/// the number of entries that it must have.
template <typename Captured, typename Each>
void each_member(Captured& captured, const Each& each) {
  each("h", captured.h);
  each("g", captured.g);
  each("time", captured.time);
  each("wall_x", captured.wall_x);
  each("wall_v", captured.wall_v);
  each("load", captured.load);
  each("step", captured.step);
  each("phase", captured.phase);
  const auto contacts = static_cast<std::size_t>(captured.problem.contact_count());
  each("start", captured.start, static_cast<std::size_t>(captured.problem.row_count()));
  each("solution", captured.solution, static_cast<std::size_t>(captured.problem.row_count()));
  each("gap", captured.gap, contacts);
  each("frame", captured.frame, 9 * contacts);
  each("position", captured.position, 3 * contacts);
  each("key", captured.key, contacts);
  each("id_a", captured.id_a, contacts);
  each("id_b", captured.id_b, contacts);
}

/// Returns whether the file is an HDF5 file with the group /ballast. False for all else, also for
/// missing files.
bool is_captured(const std::filesystem::path& file);

/// Throws Error for a broken file or arrays that do not fit each other.
CapturedProblem read_captured(const std::filesystem::path& file);

/// Writes beside and renames. Throws Error; InvalidProblem for a problem without dynamics form.
void write_captured(const std::filesystem::path& file, const CapturedProblem& captured);

}  // namespace ballast
