#pragma once
// record.h5: all that a run recorded, in one file that explains itself.
//
//   /                attributes format ("ballast record 2"), bits_generation (bits_generation.hpp),
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
//                                     them: see force_log.cpp
//
// Every dataset of numbers has the attributes unit and description.

#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "experiments/record/pose_frame.hpp"
#include "experiments/step/step_record.hpp"
#include "platform/row_log.hpp"
#include "problems/mechanics/mechanical_system.hpp"

namespace ballast {

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

}  // namespace ballast
