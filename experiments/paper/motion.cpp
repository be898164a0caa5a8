#include "experiments/paper/motion.hpp"

namespace ballast {

std::vector<MotionRun> read_motion(PaperData& data, PaperSection& section) {
  std::vector<MotionRun> runs;
  for (const size_t run : data.motion()) {
    MotionRun motion{data.read(run), {}};
    motion.summary = summarise(motion.data.steps, motion.data.facts);
    runs.push_back(std::move(motion));
  }
  const size_t planned = data.campaign().motion.size();
  if (runs.size() < planned)
    section.notes.push_back("PARTIAL: " + std::to_string(runs.size()) + " of " +
                            std::to_string(planned) + " samples at 5 Hz.");
  return runs;
}

}  // namespace ballast
