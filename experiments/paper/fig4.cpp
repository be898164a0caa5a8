// Fig. 4: force of the grains on the wall against its displacement, over four periods; fits of both
// branches; the jammed state.

#include <cmath>

#include "experiments/paper/motion.hpp"
#include "experiments/run_page/figures.hpp"

namespace ballast {
namespace {

TextTable branch_table(const std::vector<MotionRun>& runs) {
  TextTable table{"Branches of f_g, and the jam, sample by sample",
                  {"sample", "active: f_g at ξ = 0 (m g)", "growth over the stroke (exp)",
                   "R² exponential", "R² line", "passive: f_g at ξ = 0 (m g)", "slope (m g/mm)",
                   "R²", "jam: |f_g − f|/f_max", "jam: |v| mean, largest (mm/s)"},
                  {}};
  for (size_t k = 0; k < runs.size(); ++k) {
    const RunSummary& s = runs[k].summary;
    const double weight = s.facts.grain_mass * s.facts.gravity;
    table.rows.push_back(
        {std::to_string(k + 1), digits(s.loop.active.amplitude / weight),
         digits(std::exp(s.loop.active.rate * s.rise.mean)), digits(s.loop.active.r2),
         digits(s.loop.active_line.r2), digits(s.loop.passive.offset / weight),
         digits(1e-3 * s.loop.passive.slope / weight), digits(s.loop.passive.r2),
         digits(s.jammed.force_mean, 2),
         digits(1e3 * s.jammed.speed_mean, 2) + ", " + digits(1e3 * s.jammed.speed_max, 2)});
  }
  return table;
}

Agreement judge_fit(const SampleMean& r2) {
  if (!std::isfinite(r2.mean)) return Agreement::reported;
  return r2.mean > 0.9 ? Agreement::agrees : r2.mean > 0.6 ? Agreement::partly : Agreement::differs;
}

}  // namespace

PaperSection fig4_section(PaperData& data) {
  PaperSection section;
  section.text = {
      "Per step, f_g is the sum of the step’s impulses on the wall divided by h, and noisy; the "
      "branches are fitted to "
      "its low-pass (Hann window, "
      "4 ms) in the middle 80 % of each stroke, against ξ, the displacement from the stroke’s own "
      "jamming position. "
      "Jammed: the longest "
      "stretch of |v| ≤ 2 % of its largest value that holds a load above the mean; measured only "
      "where the load is "
      "above its mean. "
      "Since f_g ≈ f follows from Eq. 2 wherever the wall is slow, the residual velocity is the "
      "sensitive measure."};
  const std::vector<MotionRun> runs = read_motion(data, section);
  if (runs.empty() || runs.front().summary.wall.loop_first >= runs.front().summary.wall.loop_last)
    return section;
  const SampleMean active = mean_over(runs, [](const RunSummary& s) { return s.loop.active.r2; });
  const SampleMean passive = mean_over(runs, [](const RunSummary& s) { return s.loop.passive.r2; });
  const SampleMean jam = mean_over(runs, [](const RunSummary& s) { return s.jammed.force_mean; });
  const SampleMean smooth =
      mean_over(runs, [](const RunSummary& s) { return s.jammed.force_smooth; });
  const SampleMean creep =
      mean_over(runs, [](const RunSummary& s) { return 1e3 * s.jammed.speed_mean; });
  const SampleMean speed =
      mean_over(runs, [](const RunSummary& s) { return 1e3 * s.speed_in.mean; });
  PaperFigure figure;
  figure.plot = figure_4(runs.front().data, runs.front().summary).plot;
  figure.paper =
      "Active phase: f_g grows slightly exponentially with x. Passive phase: it grows faster and "
      "almost linearly as x "
      "decreases. Vertical branch: jammed, f_g = f.";
  figure.found = "Sample 1 is drawn, the last periods of the run. Means over samples: R² active " +
                 digits(active.mean) + ", passive " + digits(passive.mean) +
                 "; jammed |f_g − f|/f_max " + digits(jam.mean, 2) + " per step (" +
                 digits(smooth.mean, 2) + " smoothed), residual velocity " + digits(creep.mean, 2) +
                 " mm/s, that is " + digits(creep.mean / speed.mean, 2) + " of v_max.";
  section.figures = {figure};
  section.tables = {branch_table(runs)};
  section.rows = {
      {"Fig. 4", "active: f_g slightly exponential", "R² " + with_error(active.mean, active.error),
       judge_fit(active)},
      {"Fig. 4", "passive: f_g almost linear", "R² " + with_error(passive.mean, passive.error),
       judge_fit(passive)},
      {"Fig. 4", "jammed: f_g = f (asked for: within 1e-3 f_max)",
       digits(jam.mean, 2) + " per step, " + digits(smooth.mean, 2) + " smoothed",
       jam.mean <= 1e-3      ? Agreement::agrees
       : smooth.mean <= 1e-3 ? Agreement::partly
                             : Agreement::differs},
      {"Fig. 4", "jammed: wall at rest",
       "|v| " + digits(creep.mean, 2) + " mm/s = " + digits(creep.mean / speed.mean, 2) + " v_max",
       creep.mean / speed.mean < 0.01 ? Agreement::agrees : Agreement::partly}};
  return section;
}

}  // namespace ballast
