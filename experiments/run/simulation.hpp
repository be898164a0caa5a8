#pragma once
// The loop of a run: step, observe, record, checkpoint; stops at its end, on request, or at a time
// limit.

#include <functional>

#include "experiments/record/checkpoint.hpp"
#include "experiments/step/time_step.hpp"

namespace ballast {

/// A checkpoint of a drive; its numbers are who rests (StepMemory::rest), none in scenes without
/// sleep.
Checkpoint drive_checkpoint(const std::string& key, const std::string& phase,
                            const MotionState& state, const StepMemory& memory);
/// What it holds besides the motion; moved out of it. Throws Error naming `file` when its numbers
/// are not who rests.
StepMemory memory_of(Checkpoint& checkpoint, const std::filesystem::path& file);

enum class LoopEnd { finished, interrupted, time_limit };

/// What a loop is given. `before_checkpoint` makes the records safe first, so that they never lack
/// what a checkpoint has.
struct SimulationLoop {
  long last_step = 0;
  double checkpoint_seconds = 20.0;  ///< wall clock between checkpoints
  double max_seconds = 1e30;         ///< wall clock of the loop
  std::filesystem::path checkpoint;  ///< file
  std::string key;                   ///< of the scene
  std::string phase;
  std::function<void(const MotionState&, StepRecord&)>
      observe;  ///< after each step; may fill measures in
  std::function<void()> before_checkpoint;
};

/// Runs state.step .. last_step. A checkpoint is also written at the end, whatever ends it.
LoopEnd run_loop(const SimulationLoop& loop, TimeStepper& stepper, MotionState& state,
                 StepMemory& memory);

}  // namespace ballast
