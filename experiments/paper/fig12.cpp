// Fig. 12: the solid fraction in a control volume under the initial gap, 5 Hz.

#include <cmath>

#include "experiments/page/page.hpp"
#include "experiments/paper/sections.hpp"
#include "experiments/run_page/figures.hpp"
#include "experiments/step/step_record.hpp"

namespace ballast {

PaperSection fig12_section(PaperData& data) {
  PaperSection section;
  const std::vector<size_t> runs = data.motion();
  if (runs.size() < data.campaign().motion.size())
    section.notes.push_back("PARTIAL: " + std::to_string(runs.size()) + " of " +
                            std::to_string(data.campaign().motion.size()) + " samples at 5 Hz.");
  if (runs.empty()) return section;
  const Ink inks[] = {Ink::blue, Ink::vermilion, Ink::green, Ink::purple, Ink::orange};
  Panel panel;
  panel.x_label = "{/:Italic t}  (s)";
  panel.y_label = "Δ{/:Italic ρ}";
  panel.lines = {{paper_window.begin, "0.2 s", true, Ink::grey}};
  std::vector<double> initial, reference, gain, relative;
  for (size_t k = 0; k < runs.size(); ++k) {
    const RunData run = data.read(runs[k]);
    const Observation seen = observe(run.steps, run.facts, grain_count(run));
    auto change = record_column(run.steps, &StepRecord::solid_fraction);
    for (double& value : change) value -= seen.solid_initial;
    panel.curves.push_back(line_of(record_column(run.steps, &StepRecord::time), change,
                                   "sample " + std::to_string(k + 1), inks[k % 5], 1.6));
    panel.x_min = 0.0;
    panel.x_max = run.steps.back().time;
    initial.push_back(seen.solid_initial);
    reference.push_back(seen.solid_reference);
    gain.push_back(seen.gain);
    relative.push_back(seen.gain / seen.solid_reference);
  }
  const SampleMean before = sample_mean(initial), at = sample_mean(reference),
                   step = sample_mean(gain), share = sample_mean(relative);
  PaperFigure figure;
  figure.plot.name = "fig12";
  figure.plot.title = "Change of the solid fraction against time at 5 Hz";
  figure.plot.height = 460;
  figure.plot.panels = {panel};
  figure.paper = page::words("fig12.paper");
  figure.found =
      page::words("fig12.found", {{"before", page::with_error(before.mean, before.error)},
                                  {"at", page::with_error(at.mean, at.error)},
                                  {"gain", page::with_error(step.mean, step.error)},
                                  {"share", page::with_error(share.mean, share.error)}});
  section.figures = {figure};
  const double jump = at.mean - before.mean;
  section.rows = {
      {"Fig. 12", "ρ = 0.50 before the drive", page::with_error(before.mean, before.error),
       std::abs(before.mean - 0.50) < 0.02 ? Agreement::agrees : Agreement::differs},
      {"Fig. 12", "first compaction 0.02, to ρ₀ ≈ 0.52",
       page::number(jump) + ", to " + page::with_error(at.mean, at.error),
       std::abs(jump - 0.02) < 0.005   ? Agreement::agrees
       : std::abs(jump - 0.02) < 0.012 ? Agreement::partly
                                       : Agreement::differs},
      {"Fig. 12", "constant small gain per period",
       "Δρ₁ = " + page::with_error(step.mean, step.error),
       step.mean > 0.0 && (runs.size() < 2 || step.mean > 2.0 * step.error) ? Agreement::agrees
                                                                            : Agreement::differs}};
  return section;
}

}  // namespace ballast
