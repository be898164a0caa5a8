// How loose may the solver be? The same start under more and fewer iterations and other backends:
// which observables move, by how much beyond the spread between samples, and at what cost.

#include <algorithm>
#include <cmath>

#include "experiments/paper/run_groups.hpp"

namespace ballast {
namespace {

/// One way in which the solver was loosened, on sample 1: a table and a curve.
struct Loosening {
  Varied varied;
  const char *name, *title;  ///< of the table's words, and in the legend
  Ink ink;
};
constexpr Loosening loosenings[] = {
    {Varied::iterations, "slow", "nncg, 10 Hz", Ink::blue},
    {Varied::iterations_fast, "fast", "nncg, 60 Hz", Ink::vermilion},
    {Varied::backend, "backends", "other backends, 10 Hz", Ink::green}};

double error_of(const VariedValue& value) { return value.samples.front().error_mean; }

double milliseconds(const VariedValue& value) {
  return 1e3 * value.samples.front().seconds_per_step;
}

bool is_tighter(const VariedValue& a, const VariedValue& b) { return error_of(a) < error_of(b); }

/// A quantity of the only sample.
double seen(const VariedValue& value, double Observation::*quantity) {
  return value.samples.front().*quantity;
}

/// Spread between samples: standard deviation over the base runs' seeds; relative to their mean.
double relative_spread(const RunGroup& base) {
  const SampleMean mean = base.mean_at(base_force, &Observation::rise);
  return deviation_of(mean) / std::abs(mean.mean);
}

page::Table table_of(const Loosening& what, const std::vector<VariedValue>& values,
                     const VariedValue& tightest) {
  page::Table table = observable_table(std::string("looseness.") + what.name);
  for (const VariedValue& value : values) {
    table.rows.push_back(
        {value.label, page::number(error_of(value), 2), page::number(milliseconds(value))});
    for (const ObservableColumn& column : observable_columns()) {
      const double now = seen(value, column.value), best = seen(tightest, column.value);
      page::Text cell = page::number(column.factor * now);
      if (&value != &tightest)
        cell += " (" + (best == 0.0 ? page::Text("–") : page::percent(now / best - 1.0)) + ")";
      table.rows.back().push_back(cell);
    }
  }
  return table;
}

/// Deviation of Delta x_max from the tightest run's, against the error or the time of a step.
Curve deviation_curve(const Loosening& what, const std::vector<VariedValue>& values,
                      const VariedValue& tightest, bool against_time) {
  VariedCurve points;
  for (const VariedValue& value : values) {
    if (&value == &tightest) continue;
    const double ratio = seen(value, &Observation::rise) / seen(tightest, &Observation::rise);
    points.x.push_back(against_time ? milliseconds(value) : error_of(value));
    points.y.push_back(std::max(1e-4, std::abs(ratio - 1.0)));
    points.error.push_back(0.0);
  }
  return points_of(points, what.title, what.ink);
}

Panel deviation_panel(const char* x_label, double spread) {
  Panel panel{.x_label = x_label,
              .y_label = "|deviation of Δ{/:Italic x}_{max}|",
              .log_x = true,
              .log_y = true};
  if (std::isfinite(spread) && spread > 0.0)
    panel.lines = {{spread, "spread between samples", false, Ink::grey}};
  return panel;
}

/// Loosest run whose Delta x_max lies within the samples' spread of the tightest one's, and so do
/// all tighter ones.
page::Text loosest_good(std::vector<VariedValue> values, double spread) {
  std::sort(values.begin(), values.end(), is_tighter);
  page::Text good;
  for (const VariedValue& value : values) {
    const double best = seen(values.front(), &Observation::rise);
    if (!(std::abs(seen(value, &Observation::rise) / best - 1.0) <= spread)) break;
    good = value.label + " iterations, error " + page::number(error_of(value), 2) + " g·h";
  }
  return good;
}

}  // namespace

PaperSection looseness_section(PaperData& data) {
  PaperSection section{.text = {page::words("looseness.intro")}};
  const double spread = relative_spread({"base", data.values(Varied::force)});
  Figure figure{.height = 800,
                .panels = {deviation_panel("rms error over  {/:Italic g h}", spread),
                           deviation_panel("wall clock of a step, median  (ms)", spread)}};
  for (const Loosening& what : loosenings) {
    const std::vector<VariedValue> values = read_values(data, what.varied, section);
    if (values.size() < 2) continue;
    // the others are compared with the run of the smallest error
    const VariedValue& tightest = *std::min_element(values.begin(), values.end(), is_tighter);
    section.tables.push_back(table_of(what, values, tightest));
    for (const bool against_time : {false, true})
      figure.panels[against_time].curves.push_back(
          deviation_curve(what, values, tightest, against_time));
    if (what.varied == Varied::iterations && values.size() > 2 && std::isfinite(spread))
      section.claim("looseness.claim", {{"spread", page::number(100.0 * spread, 2)},
                                        {"good", loosest_good(values, spread)}});
  }
  if (!section.tables.empty()) section.draw("looseness", figure);
  return section;
}

}  // namespace ballast
