// Figs. 3, 4 and 12: the wall at 5 Hz, the force on it, and the solid fraction.

#include <algorithm>
#include <cmath>

#include "experiments/paper/motion.hpp"
#include "experiments/run_page/figures.hpp"

namespace ballast {
namespace {

/// The paper's time lag of 0.2 s, written with one digit and "about" [s].
constexpr double paper_lag = 0.26;

double contraction_of(const RunSummary& run) { return run.contraction.size; }
double time90_of(const RunSummary& run) { return run.contraction.time90; }

/// Largest deviation of a frequency's value from the mean of all, relative: of each sample by
/// itself, then the mean over samples.
SampleMean spread_over(const Groups& groups, RunMeasure measure, double low, double high) {
  std::vector<double> spreads;
  for (const RunRow* row : groups.front().samples) {
    std::vector<double> seen;
    for (const Group& group : groups)
      if (const RunSummary* sample = group.of_seed(row->run.facts.seed);
          sample && group.value >= low && group.value <= high)
        seen.push_back(measure(*sample));
    const Statistics all = statistics(seen);
    spreads.push_back(std::max(all.max / all.mean - 1.0, 1.0 - all.min / all.mean));
  }
  return sample_mean(spreads);
}

/// The wall's displacement in the colours of its phases, with the paper's time lag.
Figure motion_figure(const MotionRun& run) {
  Figure figure = figure_3(run.data, run.summary).plot;
  const std::vector<StepRecord>& steps = run.data.steps;
  for (const auto& [phase, title, ink] : {std::tuple{WallPhase::jammed, "jammed", Ink::green},
                                          std::tuple{WallPhase::active, "active", Ink::sky},
                                          std::tuple{WallPhase::passive, "passive", Ink::orange}}) {
    std::vector<double> x;
    for (size_t k = 0; k < steps.size(); ++k)
      x.push_back(run.summary.wall.phase[k] == phase ? 1e3 * steps[k].wall_x : not_known);
    if (statistics(x).samples == 0) continue;
    figure.panels[0].curves.push_back(
        line_of(record_column(steps, &StepRecord::time), x, title, ink, 3.0));
  }
  for (Panel& panel : figure.panels)
    panel.lines.push_back({paper_window.begin, "0.2 s", true, Ink::grey});
  return figure;
}

/// The motion of the wall at 5 Hz.
void add_motion(const std::vector<MotionRun>& runs, PaperSection& section) {
  const SampleMean size = mean_over(runs, [](const auto&s) { return 1e3 * s.contraction.size; }),
                   time = mean_over(runs, [](const auto&s) { return s.contraction.time90; }),
                   rise = mean_over(runs, [](const auto&s) { return 1e3 * s.rise.mean; }),
                   net = mean_over(runs, [](const auto&s) { return -1e3 * s.net.mean; });
  const page::Values words{{"samples", std::to_string(size.samples)},
                           {"size", words_of(size)},
                           {"time", words_of(time)},
                           {"rise", words_of(rise)},
                           {"net", words_of(net)},
                           {"rise_mean", page::number(rise.mean)}};
  section.draw("fig3", motion_figure(runs.front()), words);
  section.claim("fig3.first", words, PaperRange::at_most(paper_lag), found(time));
  section.claim("fig3.slow", words, PaperRange::at_least(0.0), found(net));
}

page::Table branch_table(const std::vector<MotionRun>& runs) {
  page::Table table = page::words_table("fig4.table");
  for (size_t k = 0; k < runs.size(); ++k) {
    const RunSummary& s = runs[k].summary;
    const double weight = s.facts.grain_mass * s.facts.gravity;
    table.rows.push_back({std::to_string(k + 1), page::number(s.law.active.amplitude / weight),
                          page::number(std::exp(s.law.active.rate * s.rise.mean)),
                          page::number(s.law.active.r2), page::number(s.law.active_line.r2),
                          page::number(s.law.passive.offset / weight),
                          page::number(1e-3 * s.law.passive.slope / weight),
                          page::number(s.law.passive.r2), page::number(s.jammed.force_mean, 2),
                          page::number(1e3 * s.jammed.speed_mean, 2) + ", " +
                              page::number(1e3 * s.jammed.speed_max, 2)});
  }
  return table;
}

/// How f_g grows in the last tenth of the way in, over how it does in the middle of it: 1 for a
/// line.
double end_steepness(const MotionRun& run) {
  const RunFacts& facts = run.summary.facts;
  const ForceLaw last_tenth =
      force_law(run.data.steps, run.summary.wall, facts.grain_mass, facts.wall_mass, facts.gravity,
                {.fit_from = 0.0, .fit_to = 0.1});
  return last_tenth.passive.slope / run.summary.law.passive.slope;
}

/// A law describes a branch when it leaves at most a tenth of its variance.
const PaperRange good_fit = PaperRange::at_least(0.9);

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

void fill_motion(PaperData& data, PaperSection& section) {
  const std::vector<MotionRun> runs = read_motion(data);
  if (!runs.empty()) add_motion(runs, section);
  const Groups groups = data.groups({"", {"frequency", "slowest"}}, frequency_of);
  if (groups.size() < 2) return;
  // when the first contraction is over, at all frequencies
  const Points times = points_of(groups, frequency_of, time90_of);
  Panel panel = frequency_panel("90 % of the first contraction  (s)");
  panel.y_min = 0.0;
  panel.curves = {curve_of(times, mean_title, Ink::blue)};
  panel.lines = {{paper_window.begin, "the paper’s 0.2 s", false, Ink::vermilion}};
  section.draw("fig3_times", {.height = 400, .panels = {panel}});
  // the paper takes rho_0 at 0.2 s for every frequency: the slowest first contraction decides
  const Group& slowest = *std::ranges::max_element(
      groups, {}, [](const Group& group) { return group.mean(time90_of).mean; });
  const SampleMean latest = slowest.mean(time90_of);
  section.claim("fig3.everywhere",
                {{"time", words_of(latest)}, {"frequency", slowest.label + " Hz"}},
                PaperRange::at_most(paper_lag), found(latest));
  for (const auto& [name, measure] :
       {std::pair<const char*, RunMeasure>{"fig3.size", contraction_of},
        {"fig3.time", time90_of}}) {
    const SampleMean all = spread_over(groups, measure, 0.0, 1e9);
    section.claim(name,
                  {{"all", words_of(all, 100.0)},
                   {"count", std::to_string(groups.size())},
                   {"middle", words_of(spread_over(groups, measure, 2.0, 20.0), 100.0)}},
                  PaperRange::at_most(0.15), found(all));
  }
}

void fill_forces(PaperData& data, PaperSection& section) {
  const std::vector<MotionRun> runs = read_motion(data);
  if (runs.empty() || runs.front().summary.wall.periods.empty()) return;
  const SampleMean active = mean_over(runs, [](const auto&s) { return s.law.active.r2; }),
                   passive = mean_over(runs, [](const auto&s) { return s.law.passive.r2; }),
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
  section.draw("fig4", figure_4(shown.data, shown.summary).plot, words);
  section.add(branch_table(runs));
  section.claim("fig4.active", words, good_fit, found(active));
  section.claim("fig4.passive", words, good_fit, found(passive));
  section.claim("fig4.end", words, PaperRange::at_least(1.0), found(end));
  section.claim("fig4.jammed", words, PaperRange::at_most(target::jammed_force), found(jam));
  // jammed samples are chosen by their speed, at most 2 % of v_max: a part of the statement
  section.claim("fig4.rest", words, PaperRange::at_most(0.01), part_of(found(share)));
}

void fill_density(PaperData& data, PaperSection& section) {
  const std::vector<MotionRun> runs = read_motion(data);
  if (runs.empty()) return;
  constexpr Ink inks[] = {Ink::blue, Ink::vermilion, Ink::green, Ink::purple, Ink::orange};
  Panel panel;
  for (size_t k = 0; k < runs.size(); ++k) {
    draw_solid_fraction(runs[k].data, runs[k].summary.compaction.initial,
                        "sample " + std::to_string(k + 1), inks[k % std::size(inks)], 1.6, panel);
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
}

}  // namespace ballast
