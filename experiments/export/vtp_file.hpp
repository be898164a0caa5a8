#pragma once
// ParaView's .vtp: polygons or points with data, as VTK XML with base64 arrays (well-formed XML, no
// compression). Numbers are stored in single precision: good for pictures; the record has the full
// ones.

#include <filesystem>
#include <span>
#include <string>
#include <utility>

#include "geometry/contact/contact_detector.hpp"
#include "problems/mechanics/mechanical_system.hpp"

namespace ballast {

/// The faces of all grains in world coordinates, with cell data grain (index), mass [kg], speed and
/// velocity [m/s] of the centre of mass. Field data TimeValue [s]. Throws Error naming the file.
void write_grains_vtp(const std::filesystem::path& file, const MechanicalSystem& system,
                      const MotionState& state);

/// One point per contact with data normal_force and force on body b (vectors, world frame [N]:
/// impulses over h) and gap [m].
void write_contacts_vtp(const std::filesystem::path& file, double time,
                        std::span<const ContactPoint> contacts, std::span<const Vec3> impulses,
                        double h);

/// A .pvd: the files of a series, in the same folder, with their times [s].
void write_pvd(const std::filesystem::path& file,
               std::span<const std::pair<double, std::string>> frames);

/// TimeValue of a file written by these functions [s]. Throws Error when it has none.
double read_vtp_time(const std::filesystem::path& file);

}  // namespace ballast
