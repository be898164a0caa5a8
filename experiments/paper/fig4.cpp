// Fig. 4: force of the grains on the wall against its displacement, over four periods; fits of both
// branches; the jammed state.

#include <cmath>

#include "experiments/paper/motion.hpp"
#include "experiments/run_page/figures.hpp"

namespace ballast {
namespace {

page::Table branch_table(const std::vector<MotionRun>& runs) {
  page::Table table = page::words_table("fig4.table");
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

/// How f_g grows in the last tenth of the way in, over how it does in the middle of it: 1 for a
/// line.
double end_steepness(const MotionRun& run) {
  WallSettings last_tenth;
  last_tenth.fit_from = 0.0;
  last_tenth.fit_to = 0.1;
  return fit_loop(run.data.steps, run.summary.wall, last_tenth).passive.slope /
         run.summary.loop.passive.slope;
}

/// A law describes a branch when it leaves at most a tenth of its variance.
const PaperRange good_fit = PaperRange::at_least(0.9);

}  // namespace

PaperSection fig4_section(PaperData& data) {
  PaperSection section{.text = {page::words("fig4.intro")}};
  const std::vector<MotionRun> runs = read_motion(data, section);
  if (runs.empty() || runs.front().summary.wall.loop_first >= runs.front().summary.wall.loop_last)
    return section;
  const SampleMean active = mean_over(runs, [](const auto&s) { return s.loop.active.r2; }),
                   passive = mean_over(runs, [](const auto&s) { return s.loop.passive.r2; }),
                   jam = mean_over(runs, [](const auto&s) { return s.jammed.force_mean; }),
                   smooth = mean_over(runs, [](const auto&s) { return s.jammed.force_smooth; }),
                   creep = mean_over(runs, [](const auto&s) { return 1e3 * s.jammed.speed_mean; });
  const SampleMean share =
      mean_over(runs, [](const auto& s) { return s.jammed.speed_mean / s.speed_in.mean; });
  std::vector<double> steepness;
  for (const MotionRun& run : runs) steepness.push_back(end_steepness(run));
  const SampleMean end = sample_mean(steepness);
  const page::Values words{{"end", words_of(end)},
                           {"active", page::number(active.mean)},
                           {"active_r2", words_of(active)},
                           {"passive", page::number(passive.mean)},
                           {"passive_r2", words_of(passive)},
                           {"jam", page::number(jam.mean, 2)},
                           {"smooth", page::number(smooth.mean, 2)},
                           {"creep", page::number(creep.mean, 2)},
                           {"share", page::number(share.mean, 2)}};
  const MotionRun& shown = runs.front();
  section.draw("fig4", of_run(shown, figure_4(shown.data, shown.summary).plot), words);
  section.tables = {branch_table(runs)};
  section.claim("fig4.active", words, good_fit, found(active));
  section.claim("fig4.passive", words, good_fit, found(passive));
  section.claim("fig4.end", words, PaperRange::at_least(1.0), found(end));
  section.claim("fig4.jammed", words, PaperRange::at_most(target::jammed_force), found(jam));
  // jammed samples are chosen by their speed, at most 2 % of v_max: a part of the statement
  section.claim("fig4.rest", words, PaperRange::at_most(0.01), part_of(found(share)));
  return section;
}

}  // namespace ballast
