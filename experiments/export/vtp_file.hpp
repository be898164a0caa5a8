#pragma once
// ParaView's .vtp: polygons or points with data, as VTK XML with base64 arrays (well-formed XML, no
// compression). Numbers are stored in single precision: good for pictures; the record has the full
// ones.

#include <filesystem>
#include <span>
#include <string>
#include <utility>
#include <vector>

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

// ParaView's view of a run while it goes: paraview/grains_<step>.vtp with grains.pvd, and contacts
// likewise.

/// A time series that is whole after every call: each file is written beside and renamed, then its
/// .pvd. A series found in the folder is continued: frames with step > `last_step` are deleted (0:
/// all of them), the .pvd is rebuilt from the rest.
class ParaviewSeries {
 public:
  /// Writes into `folder`/paraview. `system` must outlive the series. Throws Error naming the file.
  ParaviewSeries(const std::filesystem::path& folder, const MechanicalSystem& system,
                 long last_step);

  void add(const MotionState& state);

  /// With the contacts of the last step: `impulses` on body b, world frame [N s], of a step of
  /// length h [s].
  void add(const MotionState& state, std::span<const ContactPoint> contacts,
           std::span<const Vec3> impulses, double h);

 private:
  struct Frame {
    long step;
    double time;
  };
  struct Series {
    const char* name;
    std::vector<Frame> frames;
  };
  void recover(Series& series, long last_step);
  void write_collection(const Series& series) const;
  std::filesystem::path frame_file(const Series& series, long step) const;

  std::filesystem::path folder_;
  const MechanicalSystem& system_;
  Series grains_{"grains", {}}, contacts_{"contacts", {}};
};

}  // namespace ballast
