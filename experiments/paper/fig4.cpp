// Fig. 4: force of the grains on the wall against its displacement, over four periods; fits of both
// branches; the jammed state.

#include <cmath>

#include "experiments/page/page.hpp"
#include "experiments/paper/motion.hpp"
#include "experiments/run_page/figures.hpp"

namespace ballast {
namespace {

page::Table branch_table(const std::vector<MotionRun>& runs) {
  page::Table table{"Branches of f_g, and the jam, sample by sample",
                    {"sample", "active: f_g at ξ = 0 (m g)", "growth over the stroke (exp)",
                     "R² exponential", "R² line", "passive: f_g at ξ = 0 (m g)", "slope (m g/mm)",
                     "R²", "jam: |f_g − f|/f_max", "jam: |v| mean, largest (mm/s)"},
                    {}};
  for (size_t k = 0; k < runs.size(); ++k) {
    const RunSummary& s = runs[k].summary;
    const double weight = s.facts.grain_mass * s.facts.gravity;
    table.rows.push_back({std::to_string(k + 1), page::number(s.loop.active.amplitude / weight),
                          page::number(std::exp(s.loop.active.rate * s.rise.mean)),
                          page::number(s.loop.active.r2), page::number(s.loop.active_line.r2),
                          page::number(s.loop.passive.offset / weight),
                          page::number(1e-3 * s.loop.passive.slope / weight),
                          page::number(s.loop.passive.r2), page::number(s.jammed.force_mean, 2),
                          page::number(1e3 * s.jammed.speed_mean, 2) + ", " +
                              page::number(1e3 * s.jammed.speed_max, 2)});
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
  section.text = {page::words("fig4.intro")};
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
  figure.paper = page::words("fig4.paper");
  figure.found = page::words("fig4.found", {{"active", page::number(active.mean)},
                                            {"passive", page::number(passive.mean)},
                                            {"jam", page::number(jam.mean, 2)},
                                            {"smooth", page::number(smooth.mean, 2)},
                                            {"creep", page::number(creep.mean, 2)},
                                            {"share", page::number(creep.mean / speed.mean, 2)}});
  section.figures = {figure};
  section.tables = {branch_table(runs)};
  section.rows = {
      {"Fig. 4", "active: f_g slightly exponential",
       "R² " + page::with_error(active.mean, active.error), judge_fit(active)},
      {"Fig. 4", "passive: f_g almost linear",
       "R² " + page::with_error(passive.mean, passive.error), judge_fit(passive)},
      {"Fig. 4", "jammed: f_g = f (asked for: within 1e-3 f_max)",
       page::number(jam.mean, 2) + " per step, " + page::number(smooth.mean, 2) + " smoothed",
       jam.mean <= 1e-3      ? Agreement::agrees
       : smooth.mean <= 1e-3 ? Agreement::partly
                             : Agreement::differs},
      {"Fig. 4", "jammed: wall at rest",
       "|v| " + page::number(creep.mean, 2) +
           " mm/s = " + page::number(creep.mean / speed.mean, 2) + " v_max",
       creep.mean / speed.mean < 0.01 ? Agreement::agrees : Agreement::partly}};
  return section;
}

}  // namespace ballast
