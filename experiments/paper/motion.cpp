#include "experiments/paper/motion.hpp"

namespace ballast {

std::vector<MotionRun> read_motion(PaperData& data, PaperSection& section) {
  std::vector<MotionRun> runs;
  for (const size_t run : data.motion()) {
    MotionRun motion{data.read(run), {}};
    WallSettings settings;
    settings.first_transient = transient_of(motion_frequency);
    motion.summary = summarise(motion.data.steps, motion.data.facts, settings);
    runs.push_back(std::move(motion));
  }
  const size_t planned = data.campaign().motion.size();
  if (runs.size() < planned)
    section.notes.push_back("PARTIAL: " + std::to_string(runs.size()) + " of " +
                            std::to_string(planned) + " samples at 5 Hz.");
  return runs;
}

}  // namespace ballast
