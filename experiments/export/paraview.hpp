#pragma once
// ParaView's view of a run while it goes: paraview/grains_<step>.vtp with grains.pvd, and contacts
// likewise.

#include <filesystem>
#include <span>
#include <utility>
#include <vector>

#include "geometry/contact/contact_detector.hpp"
#include "problems/mechanics/mechanical_system.hpp"

namespace ballast {

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
