// Fig. 3 and Eq. 1: displacement of the wall under the harmonic load, and the first contraction at
// all frequencies.

#include <cmath>

#include "experiments/paper/motion.hpp"
#include "experiments/run_page/figures.hpp"

namespace ballast {
namespace {

/// Largest deviation of a frequency's mean from the mean of all, relative.
double spread_over(const std::vector<VariedValue>& values, double low, double high) {
  std::vector<double> sizes;
  for (const VariedValue& value : values)
    if (value.value >= low && value.value <= high)
      sizes.push_back(value.mean(&Observation::first_contraction).mean);
  const Statistics all = statistics(sizes);
  return std::max(all.max / all.mean - 1.0, 1.0 - all.min / all.mean);
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
  section.draw("fig3", figure_3(runs.front().data, runs.front().summary).plot, words);
  section.claim("fig3.first", words, graded(time.mean < 0.25));
  section.claim("fig3.slow", words, graded(net.mean > 0.0));
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
  const double all = spread_over(values, 0.0, 1e9), middle = spread_over(values, 2.0, 20.0);
  section.claim("fig3.independent",
                {{"all", page::number(100.0 * all, 2)},
                 {"count", std::to_string(values.size())},
                 {"middle", page::number(100.0 * middle, 2)}},
                graded(all < 0.15, middle < 0.15));
  return section;
}

}  // namespace ballast
