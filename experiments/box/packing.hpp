#pragma once
// Packings: the deposit (rain to rest, lid down, lid up, settle), and the folder where they are
// kept. Each is made once, also by processes that want it at the same time.

#include <filesystem>
#include <functional>

#include "experiments/box/vibrated_box.hpp"
#include "experiments/record/checkpoint.hpp"
#include "experiments/record/progress.hpp"

namespace ballast {

/// A deposited packing, ready to be driven: the poses and velocities of grains and walls at the end
/// of the settling, the warm start for the first driven step, and how it came about. Its phase is
/// "packing", its key packing_key().
using Packing = Checkpoint;

/// Says how far a stage is: rms velocity [m/s], record of the last step. Returning false stops the
/// deposit (interrupt): it can be continued from `part`.
using DepositProgress = std::function<bool(BoxStage, double rms_velocity, const StepRecord&)>;

/// Deposits. `part`: checkpoint file of an unfinished deposit, continued when it is there, written
/// every record.checkpoint_seconds and on interrupt. `tile`: the packing of one tile, of a scene
/// that has several; copies of it stand in the place of the rain. Returns false when interrupted.
/// Throws Error when the packing doesn't come to rest.
bool deposit(const Scene& scene, const Rain& rain, const std::filesystem::path& part,
             const DepositProgress& progress, Packing& packing, const Packing* tile = nullptr);

/// False when the file is not there. Throws Error when it is broken or has another key.
bool read_packing(const std::filesystem::path& file, const std::string& key, Packing& packing);

/// The driven system and its initial state: time and step counted from the start of the drive.
MechanicalSystem drive_system(const Scene& scene, const Rain& rain, const Packing& packing,
                              MotionState& state);

/// The packing of this key (packing_key of a scene) in the folder where packings are kept.
std::filesystem::path packing_file(const std::filesystem::path& cache, const std::string& key);

struct PackingOrder {
  std::filesystem::path cache;    ///< the folder; made if it isn't there
  std::function<bool()> goes_on;  ///< asked once per step, and while waiting; false stops, to be
                                  ///< continued another time
  Progress::Style style = StatusLine::style_of_stderr();
};

/// The scene's packing from the cache; where it is missing it is deposited, or waited for when
/// another process is depositing it. Says on stdout which, on stderr how far. False: stopped.
/// Throws Error: it does not come to rest, the file is broken or cannot be written.
bool take_packing(const Scene& scene, const Rain& rain, const PackingOrder& order,
                  Packing& packing);

}  // namespace ballast
