#include "experiments/simulation.hpp"

#include <chrono>

#include "experiments/interrupt.hpp"

namespace ballast {

LoopEnd run_loop(const SimulationLoop& loop, TimeStepper& stepper, MotionState& state, StepMemory& memory) {
  using Clock = std::chrono::steady_clock;
  const auto seconds_since = [](Clock::time_point t) { return std::chrono::duration<double>(Clock::now() - t).count(); };
  const auto save = [&] {
    loop.before_checkpoint();
    write_checkpoint(loop.checkpoint, {loop.key, loop.phase, state, memory.contacts, memory.impulses, {}});
  };
  const auto begin = Clock::now();
  auto saved = begin;
  LoopEnd end = LoopEnd::finished;
  while (state.step < loop.last_step) {
    StepRecord record = stepper.step(state, memory);
    loop.observe(state, record);
    if (InterruptGuard::requested()) end = LoopEnd::interrupted;
    else if (seconds_since(begin) > loop.max_seconds) end = LoopEnd::time_limit;
    if (end != LoopEnd::finished && state.step < loop.last_step) break;
    end = LoopEnd::finished;
    if (seconds_since(saved) > loop.checkpoint_seconds) {
      save();
      saved = Clock::now();
    }
  }
  save();
  return end;
}

}  // namespace ballast
