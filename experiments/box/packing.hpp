#pragma once
// Packings: the deposit (rain to rest, lid down, lid up, settle), and the folder where they are
// kept. Each packing is made once, even if several processes ask for it at the same time.

#include <filesystem>
#include <functional>

#include "experiments/box/vibrated_box.hpp"
#include "experiments/record/checkpoint.hpp"
#include "experiments/record/progress.hpp"

namespace ballast {

/// A deposited packing, ready to be driven: the poses and velocities of grains and walls at the end
/// of the settling, the warm start for the first driven step, and the data of the deposit. Its
/// phase is "packing", its key packing_key().
using Packing = Checkpoint;

/// Receives the progress of a stage: rms velocity [m/s], record of the last step. Returning false
/// stops the deposit (interrupt); it can be continued from `part`.
using DepositProgress = std::function<bool(BoxStage, double rms_velocity, const StepRecord&)>;

/// Deposits a packing. `part`: the checkpoint file of an unfinished deposit, which is continued
/// where the file exists, and written every record.checkpoint_seconds and on interrupt. `tile`: for
/// a scene of several tiles, the packing of one; copies of it replace the rain. Returns false when
/// interrupted. Throws Error when the packing doesn't come to rest.
bool deposit(const Scene& scene, const Rain& rain, const std::filesystem::path& part,
             const DepositProgress& progress, Packing& packing, const Packing* tile = nullptr);

/// Returns false without such a file. Throws Error when it is broken or has another key.
bool read_packing(const std::filesystem::path& file, const std::string& key, Packing& packing);

/// The driven system and its initial state: time and step counted from the start of the drive.
MechanicalSystem drive_system(const Scene& scene, const Rain& rain, const Packing& packing,
                              MotionState& state);

/// The file of the packing with this key (packing_key of a scene) in the folder of packings.
std::filesystem::path packing_file(const std::filesystem::path& cache, const std::string& key);

struct PackingOptions {
  std::filesystem::path cache;       ///< the folder; created if it is missing
  std::function<bool()> keep_going;  ///< asked once per step, and while waiting; false stops the
                                     ///< deposit, which can be continued later
  Progress::Style style = StatusLine::style_of_stderr();
};

/// Takes the scene's packing from the cache. A missing one is deposited, or waited for while
/// another process deposits it. Prints on stdout which, on stderr the progress. Returns false when
/// stopped. Throws Error: it does not come to rest, the file is broken or cannot be written.
bool load_or_deposit(const Scene& scene, const Rain& rain, const PackingOptions& order,
                     Packing& packing);

}  // namespace ballast
