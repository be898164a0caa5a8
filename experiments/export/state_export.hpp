#pragma once
// States of a run as files for other programs. A file's suffix says its format:
//
//   .obj  all grains in world coordinates [m], one `o <name>` each
//   .vtp  ParaView's polygons with cell data grain (index), mass [kg], speed and velocity of the
//         centre of mass [m/s]; field data TimeValue [s]. Well-formed XML with base64 arrays in
//         single precision: good for pictures; the record has the full numbers
//
// Every file is written beside its place and renamed. All functions throw Error naming the file,
// also for another suffix.

#include <filesystem>
#include <functional>
#include <span>

#include "experiments/record/record_file.hpp"

namespace ballast {

void export_state(const MechanicalSystem& system, const MotionState& state,
                  const std::filesystem::path& file);

/// Makes the .vtp files of states, series_file(file, step), one series: writes the .pvd that names
/// them with their times and, where `contacts` gives the contacts of each state by its number, a
/// second series whose names end in "_contacts": a point for each contact with force and
/// normal_force on body b (world frame [N]).
void write_series(std::span<const MotionState> states,
                  const std::function<std::vector<FrameContact>(size_t)>& contacts,
                  const std::filesystem::path& file);
/// "folder/name.vtp" of step 50: "folder/name_00000050.vtp".
std::filesystem::path series_file(const std::filesystem::path& file, long step);

}  // namespace ballast
