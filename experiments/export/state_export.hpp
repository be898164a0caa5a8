#pragma once
// One state of a run as a file for other programs.

#include <filesystem>
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
