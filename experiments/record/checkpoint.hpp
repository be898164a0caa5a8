#pragma once
// Everything from which a run continues to the last bit.

#include <filesystem>
#include <string>

#include "experiments/step/step_record.hpp"
#include "problems/mechanics/mechanical_system.hpp"

namespace ballast {

/// What a deposit knows besides the motion. What is not reached yet is 0.
struct DepositState {
  double top = 0.0;            ///< highest vertex when the lid was raised [m]
  double lid = 0.0;            ///< height of the lid [m]
  double rain_time = 0.0;      ///< simulated until rest [s]
  double rest_velocity = 0.0;  ///< rms grain velocity at the end [m/s]
};

struct Checkpoint {
  /// Of the resolved scene; of a deposit and its packing packing_key(). Of another one it is
  /// refused.
  std::string key;
  std::string phase;  ///< "rain", "press", "settle", "packing" or "drive"
  MotionState state;
  StepMemory memory;     ///< warm start
  DepositState deposit;  ///< of a deposit and its packing; zeros in a drive
};

/// Binary, with magic, format and a checksum; written to a neighbour, fsynced, renamed. Throws
/// Error.
void write_checkpoint(const std::filesystem::path& file, const Checkpoint& checkpoint);

/// Throws Error naming the file: missing, truncated, checksum wrong, other format, or lists whose
/// lengths do not fit each other.
Checkpoint read_checkpoint(const std::filesystem::path& file);

}  // namespace ballast
