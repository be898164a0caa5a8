// Fig. 3 and Eq. 1: displacement of the wall under the harmonic load, and the first contraction at
// all frequencies.

#include <cmath>

#include "experiments/page/page.hpp"
#include "experiments/paper/motion.hpp"
#include "experiments/run_page/figures.hpp"

namespace ballast {
namespace {

page::Table contraction_table(const std::vector<VariedValue>& values) {
  page::Table table{"First contraction, means over samples ± standard error",
                    {"ν (Hz)", "samples", "size (mm)", "90 % of it by (s)"},
                    {}};
  for (const VariedValue& value : values) {
    const SampleMean size = value.mean(&Observation::first_contraction),
                     time = value.mean(&Observation::first_time90);
    table.rows.push_back({page::number(value.value), std::to_string(value.samples.size()),
                          page::with_error(1e3 * size.mean, 1e3 * size.error),
                          page::with_error(time.mean, time.error)});
  }
  return table;
}

/// Largest deviation of a frequency's mean from the mean of all, relative.
double spread_over(const std::vector<VariedValue>& values, double low, double high) {
  std::vector<double> sizes;
  for (const VariedValue& value : values)
    if (value.value >= low && value.value <= high)
      sizes.push_back(value.mean(&Observation::first_contraction).mean);
  const Statistics all = statistics(sizes);
  return std::max(all.max / all.mean - 1.0, 1.0 - all.min / all.mean);
}

}  // namespace

PaperSection fig3_section(PaperData& data) {
  PaperSection section;
  const std::vector<MotionRun> runs = read_motion(data, section);
  if (!runs.empty()) {
    PaperFigure figure;
    figure.plot = figure_3(runs.front().data, runs.front().summary).plot;
    const SampleMean size =
        mean_over(runs, [](const RunSummary& s) { return 1e3 * s.contraction.size; });
    const SampleMean time =
        mean_over(runs, [](const RunSummary& s) { return s.contraction.time90; });
    const SampleMean rise = mean_over(runs, [](const RunSummary& s) { return 1e3 * s.rise.mean; });
    const SampleMean net = mean_over(runs, [](const RunSummary& s) { return -1e3 * s.net.mean; });
    figure.paper = page::words("fig3.paper");
    figure.found = page::words("fig3.found", {{"samples", std::to_string(size.samples)},
                                              {"size", page::with_error(size.mean, size.error)},
                                              {"time", page::with_error(time.mean, time.error)},
                                              {"rise", page::with_error(rise.mean, rise.error)},
                                              {"net", page::with_error(net.mean, net.error)}});
    section.figures = {figure};
    section.rows.push_back({"Fig. 3", "first contraction over within ~0.2 s",
                            "90 % of it by " + page::with_error(time.mean, time.error) + " s",
                            time.mean < 0.25 ? Agreement::agrees : Agreement::differs});
    section.rows.push_back({"Fig. 3", "slow contraction from period to period",
                            page::with_error(net.mean, net.error) + " mm a period (rise " +
                                page::number(rise.mean) + " mm)",
                            net.mean > 0.0 ? Agreement::agrees : Agreement::differs});
  }
  const std::vector<VariedValue> values = data.values(Varied::frequency);
  note_missing(data, Varied::frequency, "frequencies", section);
  if (values.size() < 2) return section;
  section.tables.push_back(contraction_table(values));
  const double all = spread_over(values, 0.0, 1e9), middle = spread_over(values, 2.0, 20.0);
  section.rows.push_back({"Fig. 3", "first contraction almost independent of frequency",
                          "within " + page::number(100.0 * all, 2) + " % of the mean over " +
                              std::to_string(values.size()) +
                              " frequencies (2–20 Hz: " + page::number(100.0 * middle, 2) + " %)",
                          all < 0.15      ? Agreement::agrees
                          : middle < 0.15 ? Agreement::partly
                                          : Agreement::differs});
  return section;
}

}  // namespace ballast
