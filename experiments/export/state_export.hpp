#pragma once
// One state of a run as a file for other programs.

#include <filesystem>
#include <span>
#include <string>

#include "problems/mechanics/mechanical_system.hpp"

namespace ballast {

/// obj      all grains in world coordinates [m], one `o <name>` each
/// text     a table of bodies, one a row: name, mass, position, quaternion, velocity, spin (all in
///          the world frame)
/// vtp      ParaView polygons with grain, mass, speed and velocity as cell data
/// engines  two files that the benches of other physics engines read: see export_state
enum class ExportFormat { obj, text, vtp, engines };

/// By its name ("obj", ...). Throws Error with the list of names.
ExportFormat export_format(const std::string& name);

/// What a file of this suffix is: .obj, .txt, .vtp. Throws Error for others: engines has none.
ExportFormat export_format_of_suffix(const std::filesystem::path& file);

/// Every state in a file of its own, series_file(file, step); with vtp also the .pvd that names
/// them with their times. The folder is made. Throws Error.
void export_series(const MechanicalSystem& system, std::span<const MotionState> states,
                   ExportFormat format, const std::filesystem::path& file);
/// "folder/name.vtp" of step 50: "folder/name_00000050.vtp".
std::filesystem::path series_file(const std::filesystem::path& file, long step);

/// Writes `file` beside and renames. Throws Error naming it.
///
/// `engines` writes a scene into `file` and the state beside it, with the suffix ".state"; numbers
/// are separated by blanks:
///   scene   N L mu density; then for each grain
///           nv nf r mass Ix Iy Iz px py pz qw qx qy qz, nv lines x y z, nf lines i j k
///   state   for each grain px py pz qw qx qy qz vx vy vz wx wy wz
/// [SI]; r: circumradius; vertices in the body frame (centre of mass, principal axes); triangles
/// counter-clockwise from outside; v and w in the world frame. The box of that format has its floor
/// at z = 0 and frictionless walls at x, y = -L/2 and L/2, so the grains are moved there; a system
/// without floor and four upright walls, or whose two widths differ by more than 1 %, is refused
/// (of two widths that differ less, L is the larger).
void export_state(const MechanicalSystem& system, const MotionState& state, ExportFormat format,
                  const std::filesystem::path& file);

}  // namespace ballast
