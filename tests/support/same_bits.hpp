#pragma once
// The data of a run that must be the same to the last bit, even if the program was stopped between.

#include <string>

#include "experiments/record/checkpoint.hpp"
#include "experiments/record/recorder.hpp"
#include "experiments/run/run_folder.hpp"

namespace ballast {

/// All columns except the wall clocks, as bytes.
inline std::string physics_of(const std::filesystem::path& folder) {
  std::string bytes;
  for (const StepRecord& row : read_steps(folder))
    for (const StepColumn& column : step_columns())
      if (std::string(column.name).rfind("seconds_", 0) != 0)
        bytes.append(reinterpret_cast<const char*>(&(row.*column.value)), sizeof(double));
  return bytes;
}

/// The poses as bytes.
inline std::string bytes_of(const MotionState& state) {
  std::string bytes;
  for (const Pose& pose : state.pose) {
    bytes.append(reinterpret_cast<const char*>(pose.position.data()), 3 * sizeof(double));
    bytes.append(reinterpret_cast<const char*>(pose.rotation.coeffs().data()), 4 * sizeof(double));
  }
  return bytes;
}

/// The poses of the run's checkpoint as bytes.
inline std::string state_of(const std::filesystem::path& folder) {
  return bytes_of(read_checkpoint(RunFolder(folder).checkpoint()).state);
}

}  // namespace ballast
