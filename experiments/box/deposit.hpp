#pragma once
// The deposit of a packing: rain to rest, lid down, lid up, settle; and packings as files.

#include <filesystem>
#include <functional>

#include "experiments/box/vibrated_box.hpp"
#include "experiments/record/checkpoint.hpp"
#include "experiments/step/step_record.hpp"

namespace ballast {

/// A deposited packing, ready to be driven: the poses and velocities at the end of the settling,
/// the warm start for the first driven step, and how it came about.
struct Packing {
  MotionState state;  ///< grains and walls
  StepMemory memory;
  DepositState deposit;
};

/// Says how far a stage is: simulated time of the stage, rms velocity [m/s], record of the last
/// step. Returning false stops the deposit (interrupt): it can be continued from `part`.
using DepositProgress =
    std::function<bool(BoxStage, double time, double rms_velocity, const StepRecord&)>;

/// Deposits. `part`: checkpoint file of an unfinished deposit, continued when it is there, written
/// every record.checkpoint_seconds and on interrupt. Returns false when interrupted. Throws Error
/// when the packing doesn't come to rest.
bool deposit(const Scene& scene, const Rain& rain, const std::filesystem::path& part,
             const DepositProgress& progress, Packing& packing);

void write_packing(const std::filesystem::path& file, const std::string& key,
                   const Packing& packing);
/// False when the file is not there. Throws Error when it is broken or has another key.
bool read_packing(const std::filesystem::path& file, const std::string& key, Packing& packing);

/// The driven system and its initial state: time and step counted from the start of the drive.
MechanicalSystem drive_system(const Scene& scene, const Rain& rain, const Packing& packing,
                              MotionState& state);

}  // namespace ballast
