// Fig. 12: the solid fraction in a control volume under the initial gap, 5 Hz.

#include <cmath>

#include "experiments/paper/motion.hpp"
#include "experiments/run_page/figures.hpp"

namespace ballast {

PaperSection fig12_section(PaperData& data) {
  PaperSection section;
  const std::vector<MotionRun> runs = read_motion(data, section);
  if (runs.empty()) return section;
  constexpr Ink inks[] = {Ink::blue, Ink::vermilion, Ink::green, Ink::purple, Ink::orange};
  Panel panel;
  for (size_t k = 0; k < runs.size(); ++k)
    draw_solid_fraction(runs[k].data, runs[k].summary.compaction.initial,
                        "sample " + std::to_string(k + 1), inks[k % std::size(inks)], 1.6, panel);
  const auto mean = [&](double Compaction::*value) {
    return mean_over(runs, [&](const RunSummary& s) { return s.compaction.*value; });
  };
  const SampleMean before = mean(&Compaction::initial), at = mean(&Compaction::reference),
                   gain = mean(&Compaction::gain);
  const page::Values words{{"before", words_of(before)},
                           {"at", words_of(at)},
                           {"jump", page::number(at.mean - before.mean)},
                           {"gain", words_of(gain)},
                           {"share", words_of(mean(&Compaction::relative_gain))}};
  section.draw("fig12", {.height = 460, .panels = {panel}}, words);
  const double jump = std::abs(at.mean - before.mean - 0.02);
  const bool is_sure = runs.size() < 2 || gain.mean > 2.0 * gain.error;
  section.claim("fig12.before", words,
                graded(std::abs(before.mean - paper::solid_fraction_initial) < 0.02));
  section.claim("fig12.jump", words, graded(jump < 0.005, jump < 0.012));
  section.claim("fig12.gain", words, graded(gain.mean > 0.0 && is_sure));
  return section;
}

}  // namespace ballast
