#include "experiments/paper/stored_states.hpp"

#include <algorithm>
#include <cmath>

#include "experiments/run/prepared_run.hpp"
#include "experiments/run/run_folder.hpp"

namespace ballast {

int for_each_state(const MotionRun& run, const std::function<void(const StoredState&)>& see) {
  const std::filesystem::path folder = RunFolder(run.data.folder).states();
  if (!std::filesystem::is_directory(folder) || run.summary.wall.periods.empty()) return 0;
  std::vector<std::filesystem::path> files;
  for (const auto& entry : std::filesystem::directory_iterator(folder))
    if (entry.path().extension() == ".bin") files.push_back(entry.path());
  std::sort(files.begin(), files.end());
  MotionState unused;
  const MechanicalSystem system = system_of_run(run.data.folder, unused);
  const WallCycles& wall = run.summary.wall;
  const size_t first = wall.periods.front().first, last = wall.periods.back().last;
  int count = 0;
  for (const auto& file : files) {
    StoredState state{system, read_checkpoint(file), run.summary.facts.step, WallPhase::none, 0.0};
    const size_t row = static_cast<size_t>(state.at.state.step - 1);
    if (row < first || row >= last) continue;
    state.phase = wall.phase[row];
    state.wall_speed = wall.velocity[row];
    const bool moves = state.phase == WallPhase::active || state.phase == WallPhase::passive;
    const double largest =
        state.phase == WallPhase::active ? run.summary.speed_out.mean : run.summary.speed_in.mean;
    if (moves && std::abs(state.wall_speed) < 0.2 * largest) continue;
    see(state);
    ++count;
  }
  return count;
}

}  // namespace ballast
