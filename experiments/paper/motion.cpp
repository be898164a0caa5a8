#include "experiments/paper/motion.hpp"

#include <cmath>

#include "experiments/run/prepared_run.hpp"
#include "experiments/run/run_folder.hpp"

namespace ballast {
namespace {

/// Below this part of its largest speed a moving wall is neither active nor passive yet.
constexpr double slow_part = 0.2;

}  // namespace

std::vector<PairForce> StoredState::pairs() const {
  return pair_forces(at.memory.contacts, at.memory.impulses, step);
}

std::vector<MotionRun> read_motion(PaperData& data) {
  std::vector<MotionRun> runs;
  for (RunData& record : data.records("motion")) {
    RunSummary summary = summarise(record.steps, record.facts);
    runs.push_back({std::move(record), std::move(summary)});
  }
  return runs;
}

int for_each_state(const MotionRun& run, const std::function<void(const StoredState&)>& see) {
  const WallCycles& wall = run.summary.wall;
  const std::vector<std::filesystem::path> files = RunFolder(run.data.folder).state_files();
  if (files.empty() || wall.periods.empty()) return 0;
  MotionState unused;
  const MechanicalSystem system = system_of_run(run.data.folder, unused);
  int count = 0;
  for (const auto& file : files) {
    StoredState state{system, read_checkpoint(file), run.summary.facts.step};
    // row k of the record is step k + 1
    const size_t row = static_cast<size_t>(state.at.state.step - 1);
    if (row < wall.periods.front().first || row >= wall.periods.back().last) continue;
    state.phase = wall.phase[row];
    state.wall_speed = wall.velocity[row];
    const bool is_out = state.phase == WallPhase::active;
    const double largest = (is_out ? run.summary.speed_out : run.summary.speed_in).mean;
    if ((is_out || state.phase == WallPhase::passive) &&
        std::abs(state.wall_speed) < slow_part * largest)
      continue;
    see(state);
    ++count;
  }
  return count;
}

}  // namespace ballast
