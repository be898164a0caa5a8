#pragma once
// Everything that a run needs to continue with the same bits.

#include <filesystem>
#include <string>

#include "experiments/step/step_record.hpp"
#include "problems/mechanics/mechanical_system.hpp"

namespace ballast {

/// The state of a deposit besides its motion. Values that are not reached yet are 0.
struct DepositState {
  double top = 0.0;            ///< of the packing when the lid was raised [m]
  double lid = 0.0;            ///< height of the lid [m]
  double rain_time = 0.0;      ///< simulated time until rest [s]
  double rest_velocity = 0.0;  ///< rms grain velocity at the end [m/s]
};

struct Checkpoint {
  /// The key of the resolved scene, for a deposit and its packing packing_key(). A checkpoint with
  /// another key is refused.
  std::string key;
  std::string phase;  ///< "rain", "press", "settle", "packing" or "drive"
  MotionState state;
  StepMemory memory;     ///< warm start
  DepositState deposit;  ///< of a deposit and its packing; zeros in a drive
};

/// Writes a binary file with magic, format and a checksum to a neighbour, which is fsynced and
/// renamed. Throws Error.
void write_checkpoint(const std::filesystem::path& file, const Checkpoint& checkpoint);

/// Throws Error naming the file: missing, truncated, checksum wrong, other format, or lists whose
/// lengths do not fit each other.
Checkpoint read_checkpoint(const std::filesystem::path& file);

}  // namespace ballast
