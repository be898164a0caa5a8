#pragma once
// Everything from which a run continues to the last bit.

#include <filesystem>
#include <string>

#include "geometry/contact/contact_detector.hpp"
#include "problems/mechanics/mechanical_system.hpp"

namespace ballast {

struct Checkpoint {
  std::string
      key;  ///< hash of the resolved scene (and phase): a checkpoint of another scene is refused
  std::string phase;  ///< "deposit", "press", "drive", ...
  MotionState state;
  std::vector<ContactPoint> contacts;  ///< of the last step, with
  std::vector<Vec3> impulses;   ///< their impulses on body b, world frame [N s]: the warm start
  std::vector<double> numbers;  ///< whatever else the phase keeps, in its own order
};

/// Binary, little-endian, with magic, version and a checksum; written to a neighbour, fsynced,
/// renamed. Throws Error.
void write_checkpoint(const std::filesystem::path& file, const Checkpoint& checkpoint);

/// Throws Error naming the file: missing, truncated, checksum wrong, other version.
Checkpoint read_checkpoint(const std::filesystem::path& file);

}  // namespace ballast
