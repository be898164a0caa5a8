// Fig. 3 and Eq. 1: displacement of the wall under the harmonic load, and the first contraction at
// all frequencies.

#include <algorithm>
#include <cmath>

#include "experiments/paper/motion.hpp"
#include "experiments/run_page/figures.hpp"

namespace ballast {
namespace {

/// The paper's time lag of 0.2 s, written with one digit and "about" [s].
constexpr double paper_lag = 0.26;

/// Largest deviation of a frequency's value from the mean of all, relative: of each sample by
/// itself, then the mean over samples.
SampleMean spread_over(const std::vector<VariedValue>& values, double Observation::*quantity,
                       double low, double high) {
  std::vector<double> spreads;
  for (const int seed : values.front().seeds) {
    std::vector<double> seen;
    for (const VariedValue& value : values)
      if (const Observation* sample = value.of_seed(seed);
          sample && value.value >= low && value.value <= high)
        seen.push_back(sample->*quantity);
    const Statistics all = statistics(seen);
    spreads.push_back(std::max(all.max / all.mean - 1.0, 1.0 - all.min / all.mean));
  }
  return sample_mean(spreads);
}

/// The value of the frequency at which a quantity's mean is largest.
const VariedValue& largest_of(const std::vector<VariedValue>& values,
                              double Observation::*quantity) {
  return *std::max_element(values.begin(), values.end(), [&](const auto& a, const auto& b) {
    return a.mean(quantity).mean < b.mean(quantity).mean;
  });
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

/// When the first contraction is over, at all frequencies.
void draw_times(const std::vector<VariedValue>& values, PaperSection& section) {
  Panel panel = frequency_panel("90 % of the first contraction  (s)");
  panel.y_min = 0.0;
  panel.curves = {
      points_of(curve_of_values(values, &Observation::first_time90), mean_title, Ink::blue)};
  panel.lines = {{paper_window.begin, "the paper’s 0.2 s", false, Ink::vermilion}};
  section.draw("fig3_times", {.height = 400, .panels = {panel}});
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
  section.draw("fig3", of_run(runs.front(), motion_figure(runs.front())), words);
  section.claim("fig3.first", words, PaperRange::at_most(paper_lag), found(time));
  section.claim("fig3.slow", words, PaperRange::at_least(0.0), found(net));
}

}  // namespace

PaperSection fig3_section(PaperData& data) {
  PaperSection section;
  const std::vector<MotionRun> runs = read_motion(data, section);
  if (!runs.empty()) add_motion(runs, section);
  const std::vector<VariedValue> values = read_values(data, Varied::frequency, section);
  if (values.size() < 2) return section;
  page::Table table = page::words_table("fig3.table");
  for (const VariedValue& value : values)
    table.rows.push_back({page::number(value.value), samples_of(value),
                          words_of(value.mean(&Observation::first_contraction), 1e3),
                          words_of(value.mean(&Observation::first_time90))});
  section.tables.push_back(table);
  draw_times(values, section);
  // the paper takes rho_0 at 0.2 s for every frequency: the slowest first contraction decides
  const VariedValue& slowest = largest_of(values, &Observation::first_time90);
  const SampleMean latest = slowest.mean(&Observation::first_time90);
  section.claim("fig3.everywhere", {{"time", words_of(latest)}, {"frequency", slowest.label}},
                PaperRange::at_most(paper_lag), found(latest));
  for (const auto& [name, quantity] : {std::pair{"fig3.size", &Observation::first_contraction},
                                       std::pair{"fig3.time", &Observation::first_time90}}) {
    const SampleMean all = spread_over(values, quantity, 0.0, 1e9);
    section.claim(name,
                  {{"all", words_of(all, 100.0)},
                   {"count", std::to_string(values.size())},
                   {"middle", words_of(spread_over(values, quantity, 2.0, 20.0), 100.0)}},
                  PaperRange::at_most(0.15), found(all));
  }
  return section;
}

}  // namespace ballast
