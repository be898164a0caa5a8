#include "experiments/run/simulation.hpp"

#include <cmath>
#include <limits>

#include "platform/clock.hpp"
#include "platform/error.hpp"
#include "platform/interrupt.hpp"

namespace ballast {

Checkpoint drive_checkpoint(const std::string& key, const std::string& phase,
                            const MotionState& state, const StepMemory& memory) {
  return {key,
          phase,
          state,
          memory.contacts,
          memory.impulses,
          {memory.rest.begin(), memory.rest.end()}};
}

StepMemory memory_of(Checkpoint& checkpoint, const std::filesystem::path& file) {
  StepMemory memory{std::move(checkpoint.contacts), std::move(checkpoint.impulses)};
  for (const double number : checkpoint.numbers) {
    if (!(number >= StepMemory::asleep && number <= std::numeric_limits<int>::max() &&
          number == std::floor(number)))
      throw Error(file.string() + ": checkpoint is inconsistent: " + std::to_string(number) +
                  " is no number of steps at rest");
    memory.rest.push_back(static_cast<int>(number));
  }
  if (!memory.rest.empty() && memory.rest.size() != checkpoint.state.pose.size())
    throw Error(file.string() + ": checkpoint is inconsistent: rest of " +
                std::to_string(memory.rest.size()) + " bodies");
  return memory;
}

LoopEnd run_loop(const SimulationLoop& loop, TimeStepper& stepper, MotionState& state,
                 StepMemory& memory) {
  const auto save = [&] {
    loop.before_checkpoint();
    write_checkpoint(loop.checkpoint, drive_checkpoint(loop.key, loop.phase, state, memory));
  };
  const Stopwatch since_begin;
  Stopwatch since_saved;
  LoopEnd end = LoopEnd::finished;
  while (state.step < loop.last_step) {
    StepRecord record = stepper.step(state, memory);
    loop.observe(state, record);
    if (state.step % stepper.steps_between_restarts() != 0 || state.step >= loop.last_step)
      continue;
    if (InterruptGuard::requested())
      end = LoopEnd::interrupted;
    else if (since_begin.seconds() > loop.max_seconds)
      end = LoopEnd::time_limit;
    if (end != LoopEnd::finished) break;
    if (since_saved.seconds() > loop.checkpoint_seconds) {
      save();
      since_saved.restart();
    }
  }
  save();
  return end;
}

}  // namespace ballast
