// How loose may the solver be? The same start under more and fewer iterations and other backends:
// which observables move, by how much beyond the spread between samples, and at what cost.

#include <algorithm>
#include <cmath>

#include "experiments/page/page.hpp"
#include "experiments/paper/sections.hpp"

namespace ballast {
namespace {

/// Spread between samples: standard deviation over the base runs' seeds; relative to their mean.
double relative_spread(const std::vector<VariedValue>& base, double Observation::*quantity) {
  for (const VariedValue& value : base) {
    if (value.value != base_force) continue;
    const SampleMean mean = value.mean(quantity);
    return mean.error * std::sqrt(static_cast<double>(mean.samples)) / std::abs(mean.mean);
  }
  return not_known;
}

/// The run that the others are compared with: the smallest error.
const VariedValue* tightest(const std::vector<VariedValue>& values) {
  const auto least = std::min_element(
      values.begin(), values.end(), [](const VariedValue& a, const VariedValue& b) {
        return a.samples.front().error_mean < b.samples.front().error_mean;
      });
  return least == values.end() ? nullptr : &*least;
}

page::Text change(double value, double reference) {
  return reference == 0.0 ? "–" : page::percent(value / reference - 1.0);
}

page::Table table_of(const std::vector<VariedValue>& values, const std::string& caption) {
  page::Table table{caption, {"solver", "error (g·h)", "ms a step (median)"}, {}};
  for (const ObservableColumn& column : observable_columns())
    table.head.push_back(std::string(column.name) + " (" + column.unit + ")");
  const VariedValue* reference = tightest(values);
  for (const VariedValue& value : values) {
    const Observation& seen = value.samples.front();
    table.rows.push_back(
        {value.label, page::number(seen.error_mean, 2), page::number(1e3 * seen.seconds_per_step)});
    for (const ObservableColumn& column : observable_columns()) {
      page::Text cell = page::number(column.factor * seen.*column.value);
      if (&value != reference)
        cell += " (" + change(seen.*column.value, reference->samples.front().*column.value) + ")";
      table.rows.back().push_back(cell);
    }
  }
  return table;
}

/// Relative deviation of an observable from the tightest run's.
Curve deviation_curve(const std::vector<VariedValue>& values, double Observation::*quantity,
                      const char* title, Ink ink, bool against_time) {
  const VariedValue* reference = tightest(values);
  std::vector<double> x, y;
  for (const VariedValue& value : values) {
    if (&value == reference) continue;
    const Observation& seen = value.samples.front();
    x.push_back(against_time ? 1e3 * seen.seconds_per_step : seen.error_mean);
    y.push_back(
        std::max(1e-4, std::abs(seen.*quantity / (reference->samples.front().*quantity) - 1.0)));
  }
  return points_of(x, y, std::vector<double>(x.size(), 0.0), title, ink);
}

PaperFigure figure_of(const std::vector<VariedValue>& values, const std::vector<VariedValue>& fast,
                      const std::vector<VariedValue>& backends, double spread) {
  PaperFigure figure;
  figure.plot.name = "looseness";
  figure.plot.title = "Deviation of the displacement against error and time of a step";
  figure.plot.height = 800;
  for (const bool against_time : {false, true}) {
    Panel panel;
    panel.x_label =
        against_time ? "wall clock of a step, median  (ms)" : "rms error over  {/:Italic g h}";
    panel.y_label = "|deviation of Δ{/:Italic x}_{max}|";
    panel.log_x = panel.log_y = true;
    if (values.size() > 1)
      panel.curves.push_back(
          deviation_curve(values, &Observation::rise, "nncg, 10 Hz", Ink::blue, against_time));
    if (fast.size() > 1)
      panel.curves.push_back(
          deviation_curve(fast, &Observation::rise, "nncg, 60 Hz", Ink::vermilion, against_time));
    if (backends.size() > 1)
      panel.curves.push_back(deviation_curve(backends, &Observation::rise, "other backends, 10 Hz",
                                             Ink::green, against_time));
    if (std::isfinite(spread) && spread > 0.0)
      panel.lines = {{spread, "spread between samples", false, Ink::grey}};
    figure.plot.panels.push_back(panel);
  }
  figure.paper = "The paper could not ask this: one code, one tolerance.";
  figure.found = page::words("looseness.found");
  return figure;
}

/// Loosest run whose Delta x_max lies within the samples' spread of the tightest one's, and so do
/// all tighter ones.
page::Text loosest_good(std::vector<VariedValue> values, double spread) {
  std::sort(values.begin(), values.end(), [](const VariedValue& a, const VariedValue& b) {
    return a.samples.front().error_mean < b.samples.front().error_mean;
  });
  page::Text good;
  for (const VariedValue& value : values) {
    const double miss =
        std::abs(value.samples.front().rise / values.front().samples.front().rise - 1.0);
    if (!(miss <= spread)) break;
    good = value.label + " iterations, error " + page::number(value.samples.front().error_mean, 2) +
           " g·h";
  }
  return good;
}

}  // namespace

PaperSection looseness_section(PaperData& data) {
  PaperSection section;
  section.text = {page::words("looseness.intro")};
  for (const auto& [varied, what] :
       {std::pair{Varied::iterations, "numbers of iterations at 10 Hz"},
        std::pair{Varied::iterations_fast, "numbers of iterations at 60 Hz"},
        std::pair{Varied::backend, "backends"}})
    note_missing(data, varied, what, section);
  const std::vector<VariedValue> values = data.values(Varied::iterations),
                                 fast = data.values(Varied::iterations_fast);
  std::vector<VariedValue> backends = data.values(Varied::backend);
  const double spread = relative_spread(data.values(Varied::force), &Observation::rise);
  if (values.size() > 1)
    section.tables.push_back(table_of(values, "nncg at 10 Hz, by iterations a step"));
  if (fast.size() > 1)
    section.tables.push_back(table_of(fast, "nncg at 60 Hz, by iterations a step"));
  if (backends.size() > 1)
    section.tables.push_back(
        table_of(backends, "Backends at 10 Hz, the same number of iterations"));
  if (values.size() < 2 && fast.size() < 2 && backends.size() < 2) return section;
  section.figures = {figure_of(values, fast, backends, spread)};
  if (values.size() > 2 && std::isfinite(spread)) {
    const page::Text good = loosest_good(values, spread);
    section.rows = {{"beyond", "–",
                     "Δx_max at 10 Hz within the spread between samples (" +
                         page::number(100.0 * spread, 2) + " %) down to: " + good,
                     Agreement::reported}};
  }
  return section;
}

}  // namespace ballast
