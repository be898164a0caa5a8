// Fig. 12: the solid fraction in a control volume under the initial gap, 5 Hz.

#include <cmath>

#include "experiments/paper/motion.hpp"
#include "experiments/run_page/figures.hpp"

namespace ballast {

namespace {

/// How the gain of a period changes while the drive goes on: the last one less the first, over
/// their mean.
double gain_trend(const RunSummary& summary) {
  const std::vector<double>& gains = summary.compaction.gains;
  return gains.size() < 2 ? not_known : (gains.back() - gains.front()) / summary.compaction.gain;
}

/// The paper's straight line with a constant gain in each period, through the level at 0.2 s: of
/// the first sample.
void add_gain_line(const MotionRun& run, Panel& panel) {
  const Compaction& compaction = run.summary.compaction;
  const double level = compaction.reference - compaction.initial, begin = paper_window.begin;
  if (!std::isfinite(compaction.gain)) return;
  panel.lines.push_back(
      {level, "ρ_0 = " + plot_label(page::number(compaction.reference)), false, Ink::grey});
  panel.curves.push_back(curve_of(
      [&](double t) { return level + compaction.gain * run.summary.facts.frequency * (t - begin); },
      {begin, run.data.steps.back().time, false}, "Δρ_1 a period, sample 1", Ink::black));
}

}  // namespace

PaperSection fig12_section(PaperData& data) {
  PaperSection section;
  const std::vector<MotionRun> runs = read_motion(data, section);
  if (runs.empty()) return section;
  constexpr Ink inks[] = {Ink::blue, Ink::vermilion, Ink::green, Ink::purple, Ink::orange};
  Panel panel;
  for (size_t k = 0; k < runs.size(); ++k) {
    draw_solid_fraction(runs[k].data, runs[k].summary.compaction.initial,
                        "sample " + std::to_string(k + 1), inks[k % std::size(inks)], 1.6, panel);
    panel.curves.back().origins = {runs[k].origin};
  }
  const auto mean = [&](double Compaction::*value) {
    return mean_over(runs, [&](const RunSummary& s) { return s.compaction.*value; });
  };
  const SampleMean before = mean(&Compaction::initial), at = mean(&Compaction::reference),
                   gain = mean(&Compaction::gain),
                   jump = mean_over(runs,
                                    [](const RunSummary&s) {
                                      return s.compaction.reference - s.compaction.initial;
                                    }),
                   trend = mean_over(runs, gain_trend);
  add_gain_line(runs.front(), panel);
  const page::Values words{
      {"before", words_of(before)},      {"at", words_of(at)},
      {"jump", words_of(jump)},          {"gain", words_of(gain)},
      {"trend", words_of(trend, 100.0)}, {"share", words_of(mean(&Compaction::relative_gain))}};
  section.draw("fig12", {.height = 460, .panels = {panel}}, words);
  // the paper writes both fractions with two digits
  section.claim("fig12.before", words, PaperRange::about(paper::solid_fraction_initial, 0.005),
                found(before));
  section.claim("fig12.jump", words, PaperRange::about(0.02, 0.01), found(jump));
  section.claim("fig12.gain", words, PaperRange::at_least(0.0), found(gain));
  section.claim("fig12.constant", words, PaperRange::about(0.0, 0.3), found(trend));
  return section;
}

}  // namespace ballast
